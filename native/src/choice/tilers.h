// The tilings of a part by what is asked of them. What was placed last is kept, so that other dials are quick.
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "base/resource_pool.h"
#include "choice/part.h"
#include "choice/seamless_map.h"

namespace holomorph::choice {

/// Poles of a part, and the tilings with them. Several threads may use one.
class Tiler {
 public:
  /// Places the poles. @param like null, or another of the same surface, whose bases are taken
  /// @throws TopologyError for poles that do not fit; SolverError; Cancelled, as all below
  Tiler(PartPointer part, const PoleChoice& poles, BoundaryLines boundary, bool is_evened, const std::string& solver,
        std::shared_ptr<const tiling::Levels> levels, const Tiler* like, Execution& execution);

  const tiling::Placement& placement() const { return placement_; }

  /// @throws TopologyError for fewer tiles than the part needs, and for more added distortion than is wanted
  SeamlessPointer tile(const TileOptions& options, Execution& execution) const;
  /// Gives a tiling of these poles another evenness. Quick.
  SeamlessPointer evened(const SeamlessMap& tiling, double evenness, Execution& execution) const;
  /// Moves some of its poles (tiling/tiling.h).
  SeamlessPointer moved(const SeamlessMap& tiling, const std::vector<tiling::PoleMove>& moves, double evenness,
                        Execution& execution) const;

 private:
  SeamlessPointer value(tiling::Tiling tiling, bool is_upright, Execution& execution) const;

  PartPointer part_;
  tiling::Placement placement_;
};
using TilerPointer = std::shared_ptr<const Tiler>;

/// Makes a tiling that turns. @param tiles 0: a number that suits it
SeamlessPointer turned_tiling(tiling::TurnedTiler& tiler, const Part& part, int turns, double tiles, double evenness,
                              Execution& execution);

/// The tilings of one part.
class Tilers {
 public:
  explicit Tilers(PartPointer part) : part_(std::move(part)) {}

  const PartPointer& part() const { return part_; }

  /// The tiling; the last ones are kept, and evened for another evenness. @throws as Tiler and tiling::TurnedTiler;
  /// std::invalid_argument for choices that a tiling that turns has not
  SeamlessPointer tile(const TileOptions& options, Execution& execution);

  /// The 95 % over 5 % quantile of the density of tilings without poles, about, before they are rounded and evened.
  double ratio_without_poles(BoundaryLines boundary, bool is_evened, Execution& execution);
  /// About what is minded of the squares of a tiling that turns (tiling/cones/turned_map.h).
  double guess_turned(const TileOptions& options, Execution& execution);
  /// The last ones are kept.
  TilerPointer tiler(const PoleChoice& poles, BoundaryLines boundary, bool is_evened, Execution& execution);
  std::shared_ptr<const tiling::Levels> levels(Execution& execution);

 private:
  struct TilerKey {
    PoleChoice poles;
    BoundaryLines boundary;
    bool is_evened;
    bool operator==(const TilerKey&) const = default;
  };
  struct TurnedKey {
    int turns;
    tiling::Rows rows;
    Heading heading;
    std::vector<mesh::Pair> marked;
    std::optional<std::vector<int>> missing;
    bool operator==(const TurnedKey&) const = default;
  };
  // What a tiling was made of; its tiler stays as long as it is kept.
  using ShiftedKey = std::pair<TilerPointer, TileOptions>;
  using TurnedMapKey = std::tuple<std::shared_ptr<tiling::TurnedTiler>, double, double>;
  static constexpr std::size_t kKept = 2;    // more poles are tried where some are too few
  static constexpr std::size_t kTurned = 3;  // without lines, with whole ones, and with free ones

  SeamlessPointer shifted(const TileOptions& options, Execution& execution);
  SeamlessPointer turned(const TileOptions& options, Execution& execution);
  std::shared_ptr<tiling::TurnedTiler> turned_tiler(const TileOptions& options, Execution& execution);

  PartPointer part_;
  Newest<int, std::shared_ptr<const tiling::Levels>> levels_;
  Newest<TilerKey, TilerPointer> tilers_{kKept};
  Newest<ShiftedKey, SeamlessPointer> shifted_{kKept};
  Newest<TurnedKey, std::shared_ptr<tiling::TurnedTiler>> turned_{kTurned};
  Newest<TurnedMapKey, SeamlessPointer> turned_maps_{kTurned};
};

}  // namespace holomorph::choice
