// Seamless maps whose sides of a cut may also turn, by the symmetry of the texture: integer-grid maps (Bommes and
// others 2013, doi:10.1145/2461912.2462014), whose cones and whole numbers are found as in docs/method/turns.md.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "tiling/cones/placed_cones.h"
#include "tiling/levels.h"
#include "uv/quality.h"

namespace holomorph::tiling {

struct TurnedMap {
  uv::UvArray uv;            ///< #C x 2, in the plane
  uv::Quality before;        ///< before it was evened, of the level that it was made on
  std::vector<Jump> jumps;   ///< of the edges across which the UVs jump
  std::vector<int> cones;    ///< vertices
  std::vector<int> missing;  ///< of each cone: k-th turns that are missing around it
};

/// The turned maps of a surface, made on a level of it and carried to all its triangles, but where it has lines or
/// cones are chosen. Cones are searched for when a map is made, and kept for others with about as many
/// tiles.
class TurnedMaps {
 public:
  /// @param chosen #V, k-th turns that are missing around the cones; empty where these are searched for.
  /// @param levels of the surface; null: its own. @throws TopologyError for a surface without positions
  TurnedMaps(std::shared_ptr<const mesh::Surface> surface, const ConeOptions& options, Lines lines = {},
             std::vector<int> chosen = {}, std::shared_ptr<const Levels> levels = nullptr);
  ~TurnedMaps();

  const mesh::Surface& surface() const { return *surface_; }

  /// The map with about this number of tiles at its median density. Where triangles stay flipped, cones that lie
  /// further apart are tried, unless they are chosen. @throws TopologyError for chosen ones
  /// @param evenness as in uv/evening.h. @throws SolverError, Cancelled
  TurnedMap turned_map(double tiles, double evenness, Execution& execution);

  /// About what is minded of the squares of such a map (uv/appearance.h), seen on few triangles, where cones are
  /// searched for; 0 where they are not, or where that tells nothing. What it begins with is kept.
  double guess(double tiles, Execution& execution);

 private:
  struct Start {
    std::vector<int> missing;  // cones, #V of the level
    double cost = 0;
  };
  const PlacedCones& placed(int first, int far, Execution& execution);
  std::vector<int> cones_of(int first, const ConeOptions& wanted, Execution& execution);
  const Start& start(int first, Execution& execution);
  Start best_start(const ConeOptions& wanted, Execution& execution) const;
  int first_of(double tiles) const;
  ConeOptions options_of(int far) const;
  void begin(Execution& execution);
  const std::shared_ptr<const mesh::Surface>& made_on() const { return is_carried_ ? level_.surface : surface_; }
  LatticeMap on_surface(const LatticeMap& map, double evenness, Execution& execution) const;
  void turn_upright(LatticeMap& map) const;

  std::shared_ptr<const mesh::Surface> surface_;
  ConeOptions options_;
  Lines lines_;
  std::vector<int> chosen_;
  std::shared_ptr<const Levels> levels_;
  CoarseLevel level_;            // on which cones are searched for
  bool is_carried_ = false;      // whether maps are made there, too
  std::map<int, Start> starts_;  // for half the tiles each
  // The first for that many tiles, and those that start like them and lie further apart.
  std::map<std::pair<int, int>, std::unique_ptr<const PlacedCones>> placed_;
  std::mutex one_at_a_time_;
};

}  // namespace holomorph::tiling
