// The maps of a part without whole tiles: the balanced one of its structure, and flat islands.
#pragma once

#include <memory>
#include <numbers>
#include <optional>
#include <string>

#include "choice/candidate.h"
#include "choice/map.h"
#include "flat/island_search.h"

namespace holomorph::choice {

inline constexpr double kFlat = 0.3;  ///< what is minded of squares that hardly differ
/// Length of a seam across the smooth over the square root of the area, that is not minded.
inline constexpr double kMostSoft = 0.02;
/// Length of edges of 60 degrees over the square root of the area, from which on a part of up to 25,000 triangles is
/// made of these: figures have up to 3.6, machined parts 5.6 to 80. A scan of more has them by its noise.
inline constexpr double kEdged = 5;
/// Curvature off hard edges, that of two spheres: where there is more on other parts, islands have long seams.
inline constexpr double kMostCurved = 8 * std::numbers::pi;

/// Each map is made when it is asked for, once. There are no islands where they collapse, as where all faces lie on
/// lines: on a smooth part they take longer than a tiling, and cost more.
class Untiled {
 public:
  /// @param structure null to make it when it is needed
  Untiled(PartPointer part, StructurePointer structure, double evenness, bool is_upright, Execution& execution);

  /// The best islands so far, if they were looked for.
  LayoutPointer known() const { return search_ ? search_->known() : nullptr; }
  /// The islands that cost so little that hardly another map costs less, if there are any, or better ones.
  MapPointer at_once(Execution& execution);
  /// The islands of least cost, if it is below `most`, and they are found by so much work (flat/island_search.h).
  MapPointer islands(double most, double work, Execution& execution);
  /// A part of the work on a tiling, for islands beside it.
  double work() const;
  /// That on islands where all else is poor.
  double much_work() const;
  /// Whether it has such hard edges, or is so little curved off them, that islands may cost less than a tiling.
  bool may_flatten();
  /// The islands, however long they take, where no other map is tried.
  MapPointer instead(const std::string& why, Execution& execution);
  /// Those between chosen cuts. @throws TopologyError where there are none
  MapPointer along(const flat::ChosenCuts& cuts, Execution& execution) const;
  /// The balanced map.
  MapPointer balanced(const std::string& why, Execution& execution);
  /// The one of least cost, however long islands take.
  MapPointer best(const std::string& why, Execution& execution);
  /// A tiling scaled to the wanted size, as one island with its seams; null on an intrinsic surface.
  MapPointer one_island(const SeamlessMap& tiling, const std::string& why, Execution& execution) const;

 private:
  MapPointer map(LayoutPointer flat, std::string why, Execution& execution) const;
  const StructurePointer& structure(Execution& execution);

  PartPointer part_;
  StructurePointer structure_;
  double evenness_;
  bool is_upright_;
  std::unique_ptr<flat::IslandSearch> search_;
  std::optional<bool> may_flatten_;
};

}  // namespace holomorph::choice
