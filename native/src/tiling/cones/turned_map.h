// Seamless maps whose sides of a cut may also turn, by the symmetry of the texture: integer-grid maps (Bommes and
// others 2013, doi:10.1145/2461912.2462014), whose cones and whole numbers are found as in docs/method/turns.md.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "tiling/cones/placed_cones.h"

namespace holomorph::tiling {

/// The turned maps of a surface. Cones are searched for when a map is made, and kept for others with about as many
/// tiles.
class TurnedMaps {
 public:
  /// @param chosen #V, k-th turns that are missing around the cones; empty where these are searched for.
  /// @throws TopologyError for a surface without positions
  TurnedMaps(std::shared_ptr<const mesh::Surface> surface, const ConeOptions& options, Lines lines = {},
             std::vector<int> chosen = {});
  ~TurnedMaps();

  const mesh::Surface& surface() const { return *surface_; }

  /// The map with about this number of tiles at its median density. Where triangles stay flipped, cones that lie
  /// further apart are tried, unless they are chosen. @throws TopologyError for chosen ones
  /// @param evenness as in uv/evening.h. @throws SolverError, Cancelled
  TurnedMap turned_map(double tiles, double evenness, Execution& execution);

 private:
  const PlacedCones& placed(int level, Execution& execution);

  std::shared_ptr<const mesh::Surface> surface_;
  ConeOptions options_;
  Lines lines_;
  std::vector<int> chosen_;
  std::map<int, std::unique_ptr<const PlacedCones>> placed_;  // for half the tiles each
  std::mutex one_at_a_time_;
};

}  // namespace holomorph::tiling
