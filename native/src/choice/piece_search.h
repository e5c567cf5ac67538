// The map of a part in pieces between its hard edges, some of them with whole tiles; or cut open where few see it.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "choice/pieces.h"
#include "choice/request.h"
#include "choice/size.h"
#include "choice/tiling_search.h"

namespace holomorph::choice {

/// The maps of a part in pieces, by each angle between faces that divides it in another way.
class PieceSearch {
 public:
  /// @param structure of the part. @param flat its islands, null without any: only where these have a seam across the
  /// smooth or stretch a tiling is tried. The budget outlives this
  PieceSearch(Request request, StructurePointer structure, LayoutPointer flat, Budget& budget);

  /// The map of least cost, if it is below that of another one, to which that of rows that turn is added. Null without.
  /// @param rival null for none
  /// @param tries numbers of tiles for the largest piece, whose density is then that of the others; 0 where it is given
  MapPointer best(const MapPointer& rival, double density, int tries, Execution& execution);
  /// The part cut open where few see it, likewise, if the rival is a tiling that is uneven.
  MapPointer cut_open(const MapPointer& rival, double density, int tries, Execution& execution);
  /// The last map that was found, with this density.
  MapPointer resized(double density, Execution& execution);

 private:
  struct Solved {
    Piece piece;
    TilingSearch search;
  };
  struct Division {
    std::vector<int> names;      // #F, the piece of each polygon
    std::vector<Solved> pieces;  // those that may get a tiling, the largest first
    std::optional<double> cut;   // how far a cut is seen that divides nothing; none along hard edges
  };
  struct Tiled {
    const Piece* piece;
    MapPointer map;
    double turn = 0;  // cost of rows that turn in its islands
  };
  struct Minded {
    MapPointer map;
    double cost;
  };

  MapPointer best(std::vector<Division>& all, const MapPointer& rival, double density, int tries, const Window& window,
                  Execution& execution);
  std::vector<Division> divisions(Execution& execution);
  bool may_be_cut(const MapPointer& rival) const;
  std::vector<Division> in_hiding(Execution& execution);
  std::optional<TilingSearch> search_of(Piece& piece, bool is_cut, Execution& execution);
  bool is_worth(Solved& solved, const Division& division, const MapPointer& rival, double density,
                Execution& execution) const;
  std::vector<Tiled> tiled(Division& division, const MapPointer& rival, double density, int tries, const Window& window,
                           Execution& execution);
  static MapPointer of_density(TilingSearch& search, double density, int tries, const Window& window,
                               Execution& execution);
  Minded least_minded(const Division& division, const std::vector<Tiled>& tiled, Execution& execution);
  MapPointer glued(const Division& division, const std::vector<Tiled>& tiled, Execution& execution);
  MapPointer untiled(const Piece& piece, Execution& execution);
  MapPointer as_islands(const Piece& piece, Execution& execution) const;
  double cost_of_turns(const std::vector<Tiled>& tiled) const;

  Request request_;
  StructurePointer structure_;
  LayoutPointer flat_;
  Budget& budget_;
  std::optional<std::vector<Division>> found_, cut_;  // what was looked for already; cut_ none or one
  std::vector<Division>* last_ = nullptr;             // of which the last map is
  std::map<std::vector<int>, MapPointer> rest_;       // of pieces without tiling, by their polygons
};

}  // namespace holomorph::choice
