// Which map a part gets: the one that an eye minds least. What may cost less than the best so far is tried.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/errors.h"
#include "choice/map.h"
#include "choice/piece_search.h"
#include "choice/request.h"
#include "choice/size.h"
#include "choice/tiling_search.h"
#include "choice/untiled.h"

namespace holomorph::choice {

/// The maps of one part by its request. Its structure is made at once, and what is found at once; other maps when a
/// size is asked for. For one thread at a time.
class MapSearch {
 public:
  /// @param budget shared with another search of the same part; null for its own
  /// @throws what `automatic_structure` throws
  MapSearch(Request request, std::shared_ptr<Budget> budget, Execution& execution);

  /// The map whatever the size of squares; null where that decides.
  const MapPointer& final() const { return final_; }
  /// The structure of the part; null where islands took its place, as its forms would take too long, or it
  /// has none.
  const StructurePointer& structure() const { return request_.structure; }

  /// The map of least cost; where that is a tiling, the ones with all the numbers of tiles that were tried.
  /// @param tries numbers of tiles. @param leads whether the density may be another one, of which whole tiles are
  /// nearer
  /// @throws what refuses a tiling that was asked for; Cancelled
  std::vector<MapPointer> maps(double density, int tries, bool leads, Execution& execution);

  /// The tiling of `maps` that is in the window, or stretched to the density, or turned until it is in the window; else
  /// the best other map, or a tiling whose density is off by no more than `near`, relatively. What is asked for
  /// explicitly, such as poles that are chosen or moved, is made with another density.
  MapPointer fitted(const std::vector<MapPointer>& found, double density, const Window& window, double near,
                    Execution& execution);
  /// The same where `maps` was refused, for this reason. @throws std::logic_error never: see `is_strict`
  MapPointer instead_of_refused(const std::string& why, Execution& execution);
  /// Whether more is asked of a tiling than its density, so that what refuses it is not passed over.
  bool is_strict() const { return held(tilings_).is_strict(); }

  /// The map whose density is the nearest that this many numbers of tiles give.
  MapPointer about(double density, int tries, Execution& execution);

 private:
  MapPointer islands_instead(Execution& execution);
  MapPointer flat_outline(Execution& execution) const;
  MapPointer found_at_once(Execution& execution);
  std::vector<MapPointer> tried(double density, int tries, bool leads, Execution& execution);
  std::vector<Candidate> candidates(double density, int tries, bool leads);
  MapPointer in_pieces(const MapPointer& rival, bool is_cut, double density, int tries, Execution& execution);
  MapPointer best_of_others(const MapPointer& made, const std::vector<MapPointer>& found, double density,
                            const Window& window, double near, Execution& execution);
  MapPointer less_bound(const MapPointer& made, double density, const Window& window, double near,
                        Execution& execution);
  MapPointer stretched_or_turned(const MapPointer& made, double density, const Window& window, Execution& execution);
  bool may_be_better(const flat::Layout* flat) const;
  bool is_ring() const;
  std::string why_untiled() const;
  MapPointer said(const MapPointer& made) const;

  Request request_;
  std::shared_ptr<Budget> budget_;
  MapPointer final_, flat_;
  bool is_in_pieces_ = false;  // the map of least cost
  std::optional<TilingSearch> tilings_;
  std::optional<Untiled> untiled_;
  std::optional<PieceSearch> pieces_;
};

/// The number of holomorphic forms of a part without poles.
int form_count(const Part& part);
/// Whether there are so many that they are solved for only when they are asked for, as all other maps of the part take
/// less.
bool has_too_many_forms(const Part& part);
/// Whether it is a disk with an area, and all its vertices lie on the boundary: it has no forms.
/// T = 2 V - 2 - B, and B = V
bool is_outline(const Part& part);

}  // namespace holomorph::choice
