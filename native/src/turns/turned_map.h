// Seamless maps whose sides of a cut may also turn, by the symmetry of the texture: integer-grid maps (Bommes and
// others 2013, doi:10.1145/2461912.2462014), whose cones and whole numbers are found as in docs/method/turns.md.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "evening/evening.h"
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
  uv::UvArray uv;            ///< #C x 2, in coordinates of the lattice
  std::vector<Jump> jumps;   ///< of the edges across which the UVs jump
  std::vector<int> cones;    ///< vertices
  std::vector<int> missing;  ///< of each cone: k-th turns that are missing around it
};

/// What the turned maps of a surface have in common, whatever their tiles and evenness, but where cones must lie
/// further apart for a map that flips no triangle.
class PlacedCones {
 public:
  /// Finds cones on levels of the progressive mesh, frames, and the space of the maps with these.
  /// @throws TopologyError, SolverError, Cancelled
  PlacedCones(std::shared_ptr<const mesh::Surface> surface, const ConeOptions& options, Execution& execution);
  /// With cones that are given, as in cones.h.
  PlacedCones(std::shared_ptr<const mesh::Surface> surface, const ConeOptions& options, std::vector<int> missing);

  const mesh::Surface& surface() const { return *surface_; }

  /// The map with about this number of tiles at its median density.
  /// @param evenness as in evening/evening.h. @throws SolverError, Cancelled
  TurnedMap turned_map(double tiles, double evenness, Execution& execution) const;
  /// The energy of the map by its nearest whole numbers, as in evening/evening.h: what cones are compared by.
  double strain(double tiles, double evenness, Execution& execution) const;

 private:
  struct Judged {
    TurnedMap map;
    std::pair<double, double> bad{std::numeric_limits<double>::infinity(), 0};  // area flipped, strain
  };
  // The best of the maps by the nearest whole numbers.
  Judged best_map(double tiles, double evenness, Execution& execution) const;
  std::vector<NearestMap::Rounded> nearest(double tiles) const;
  Eigen::VectorXcd evened(const NearestMap::Rounded& rounded, double evenness, Execution& execution) const;
  double strain_of(const uv::UvArray& uv, double evenness, Execution& execution) const;
  evening::Kept kept() const;

  std::shared_ptr<const mesh::Surface> surface_;
  ConeOptions options_;
  Net net_;
  std::vector<int> missing_;
  Frames frames_;
  TurnedSpace space_;
  NearestMap nearest_;
  Complex level_;  // the factor at which rows are level
  struct Others {  // the same with cones further apart, once they are needed
    std::vector<std::unique_ptr<const PlacedCones>> placed;
    std::mutex one_at_a_time;
  };
  std::unique_ptr<Others> others_ = std::make_unique<Others>();
};

}  // namespace holomorph::turns
