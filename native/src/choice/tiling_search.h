// The tilings of a part, of a wanted density: the numbers of poles and of tiles that give it.
#pragma once

#include <exception>
#include <optional>
#include <vector>

#include "choice/candidate.h"
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
  /// About the least that a tiling costs; 0 where that is not known.
  double bound(double tiles, Execution& execution);
  /// The tilings that may be made with so many tiles; this outlives them.
  std::vector<Candidate> candidates(double tiles, bool size_counts);
  /// What refused the last one that could not be made; null for none.
  const std::exception_ptr& refused() const { return refused_; }
  /// The tiling of least cost, and as below. @throws what refuses the last one, if none can be made
  std::vector<MapPointer> of_density(double density, int tries, Execution& execution);
  /// A tiling, and others of its kind with other numbers of tiles, so many in all, until the density is the wanted one.
  std::vector<MapPointer> resized(MapPointer first, double density, int tries, Execution& execution);
  /// The one whose density is nearest, with the poles moved that are to be moved after the rounding.
  MapPointer moved(const std::vector<MapPointer>& tilings, double density, bool size_counts, Execution& execution);
  /// The tiling stretched to a density; null where it cannot be.
  MapPointer stretched(const Map& made, double density, Execution& execution) const;
  /// One of its kind whose rows may run less level: other numbers of tiles fit around a limb. Null where there is none.
  MapPointer less_level(const Map& made, double density, Execution& execution);

 private:
  double bound_of_turned(double tiles, Execution& execution);
  MapPointer lined(const MapPointer& turned, TileOptions options, Execution& execution);
  double length_of_lines();
  MapPointer shifted(const TileOptions& options, Execution& execution);
  TileOptions kind(const PoleChoice& poles, int turns, tiling::Rows rows) const;
  static TileOptions of_tiles(TileOptions kind, double tiles);
  static bool is_regular(const Map& made);
  MapPointer with_or_none(const TileOptions& options, Execution& execution);
  MapPointer with(TileOptions options, Execution& execution);
  void see_under_texture(SeamlessMap& made) const;
  const std::vector<int>& edges_of_lines();
  std::vector<mesh::Pair> marked() const;
  bool has_tilings_without_poles() const { return part_->type.genus > 0 || part_->type.boundary_count > 1; }

  PartPointer part_;
  StructurePointer structure_;
  Request request_;
  Budget& budget_;
  std::exception_ptr refused_;
  std::optional<double> ratio_without_poles_;
  std::optional<std::vector<int>> edges_of_lines_;
};

}  // namespace holomorph::choice
