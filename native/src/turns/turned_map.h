// Seamless maps whose sides of a cut may also turn, by the symmetry of the texture: integer-grid maps (Bommes and
// others 2013, doi:10.1145/2461912.2462014), whose cones and whole numbers are found as in docs/method/turns.md.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "turns/cones.h"
#include "turns/rounding.h"
#include "uv/uv_map.h"

namespace holomorph::turns {

/// Across an edge from the triangle on its left, seen from the lower vertex, to that on its right:
/// x' = R^turn x + translation, in coordinates of the lattice.
struct Jump {
  int edge = 0, turn = 0;
  std::array<std::int64_t, 2> translation{};
};

struct TurnedMap {
  uv::UvArray uv;           ///< #C x 2, in coordinates of the lattice
  std::vector<Jump> jumps;  ///< of the edges across which the UVs jump
};

/// What the turned maps of a surface have in common, whatever their tiles and evenness.
class PlacedCones {
 public:
  /// Finds cones on levels of the progressive mesh, frames, and the space of the maps with these.
  /// @throws TopologyError, SolverError, Cancelled
  PlacedCones(std::shared_ptr<const mesh::Surface> surface, const ConeOptions& options, Execution& execution);

  std::vector<int> cones() const;    ///< vertices
  std::vector<int> missing() const;  ///< of each cone: k-th turns that are missing around it
  const mesh::Surface& surface() const { return *surface_; }

  /// The map with about this number of tiles at its median density.
  /// @param evenness as in evening/evening.h. @throws SolverError, Cancelled
  TurnedMap turned_map(double tiles, double evenness, Execution& execution) const;

 private:
  Eigen::VectorXcd evened(const NearestMap::Rounded& rounded, double evenness, Execution& execution) const;

  std::shared_ptr<const mesh::Surface> surface_;
  Net net_;
  std::vector<int> missing_;
  Frames frames_;
  TurnedSpace space_;
  NearestMap nearest_;
  Complex level_;  // the factor at which rows are level
};

}  // namespace holomorph::turns
