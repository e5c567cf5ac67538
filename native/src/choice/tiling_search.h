// The tilings of a part, of a wanted density: the numbers of poles and of tiles that give it.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "choice/map.h"
#include "choice/request.h"
#include "choice/size.h"

namespace holomorph::choice {

/// The tilings of a part by what is asked for: poles, and other options. Poles are placed once.
class TilingSearch {
 public:
  /// @param part of the request, or a piece of it. @param structure its own. The budget outlives this
  TilingSearch(PartPointer part, StructurePointer structure, Request request, Budget& budget);

  const PartPointer& part() const { return part_; }
  /// Whether more is asked of a tiling than its density.
  bool is_strict() const;
  /// About what a tiling takes, in what `Budget` counts.
  double expected_work() const;
  /// About what a tiling without poles costs, of which only the density is known. @throws as `Tilers::tiler`
  double guess_without_poles(Execution& execution);
  /// The tilings that this many numbers of tiles give, until the density is the wanted one. @throws what refuses the
  /// first one
  std::vector<MapPointer> of_density(double density, int tries, Execution& execution);
  /// The one whose density is nearest, with the poles moved that are to be moved after the rounding.
  MapPointer moved(const std::vector<MapPointer>& tilings, double density, bool size_counts, Execution& execution);
  /// The tiling stretched to a density; null where it cannot be.
  MapPointer stretched(const Map& made, double density, Execution& execution) const;
  /// A tiling whose rows may run less level: other numbers of tiles fit around a limb. Null where there is none.
  MapPointer turned(double density, Execution& execution);

 private:
  // What differs between the tilings that are tried.
  struct Size {
    double tiles = 0;
    bool size_counts = false;
    std::optional<double> max_turn = {};
    std::vector<tiling::PoleMove> moves = {};
    bool is_of_turns = false;  // with the lattice of turns
  };

  MapPointer of_tiles(Size size, Execution& execution);
  MapPointer lined(const MapPointer& turned, const Size& size, Execution& execution);
  MapPointer with_turns(const Size& size, tiling::Rows rows, Execution& execution);
  MapPointer regular(const Size& size, Execution& execution);
  MapPointer shifted(const Size& size, Execution& execution);
  MapPointer with(const PoleChoice& poles, const Size& size, int turns, tiling::Rows rows, Execution& execution);
  template <class WithCount>
  MapPointer with_more_poles(const Map& first, const MapPointer& best, const WithCount& with_count);
  SeamlessPointer under_texture(SeamlessPointer made) const;
  const std::vector<int>& edges_of_lines();
  std::vector<mesh::Pair> marked() const;
  bool has_tilings_without_poles() const { return part_->type.genus > 0 || part_->type.boundary_count > 1; }

  PartPointer part_;
  StructurePointer structure_;
  Request request_;
  Budget& budget_;
  std::optional<double> ratio_without_poles_;
  std::optional<std::vector<int>> edges_of_lines_;
};

}  // namespace holomorph::choice
