// Cones on a surface, and the maps around them: the nearest whole numbers, evened, and what is wrong with them.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "base/constants.h"
#include "base/execution.h"
#include "tiling/cones/cones.h"
#include "tiling/cones/lines.h"
#include "tiling/cones/rounding.h"
#include "tiling/cones/turned_space.h"
#include "uv/turned_functions.h"
#include "uv/uv_map.h"

namespace holomorph::tiling {

/// Across an edge from the triangle on its left, seen from the lower vertex, to that on its right:
/// x' = R^turn x + translation, in coordinates of the lattice.
struct Jump {
  int edge = 0, turn = 0;
  std::array<std::int64_t, 2> translation{};
};

struct TurnedMap {
  uv::UvArray uv;            ///< #C x 2, in coordinates of the lattice
  uv::UvArray before;        ///< the same before it was evened
  std::vector<Jump> jumps;   ///< of the edges across which the UVs jump
  std::vector<int> cones;    ///< vertices
  std::vector<int> missing;  ///< of each cone: k-th turns that are missing around it
};

/// The work on several maps, of which the best is taken.
class Effort {
 public:
  explicit Effort(const mesh::Surface& surface)
      : most_(kMuch + kEach * static_cast<double>(surface.triangles.size())) {}

  /// Whether one more may be tried.
  bool goes_on() const { return static_cast<double>(Execution::work() - begin_) < most_; }

 private:
  static constexpr double kMuch = 1e9, kEach = 1.5e5;  // operations in all, and for each triangle
  const std::uint64_t begin_ = Execution::work();
  const double most_;
};

/// Cones on a surface, and what the maps with these have in common, whatever their tiles and evenness.
class PlacedCones {
 public:
  /// Frames, and the space of the maps with these cones. @param missing #V, as in Cones
  /// @throws SolverError, Cancelled, as all below
  PlacedCones(std::shared_ptr<const mesh::Surface> surface, const ConeOptions& options, std::vector<int> missing,
              Execution& execution);
  /// The cones and frames of a field that runs along lines.
  PlacedCones(std::shared_ptr<const mesh::Surface> surface, const ConeOptions& options, const Lines& lines,
              Execution& execution);

  struct Judged {
    TurnedMap map;
    std::pair<double, double> bad{kInfinity, 0};  ///< wrong area, strain
    bool is_last = false;                         ///< no other cones are to be tried
  };
  /// The best of the maps by the nearest whole numbers.
  Judged best_map(double tiles, double evenness, const Effort& effort, Execution& execution) const;
  /// What cones are compared by, of the map by their nearest whole numbers: the wrong area, if that is hopeless, and
  /// the energy as in uv/evening.h, with that of rows that are not level.
  std::pair<double, double> badness(double tiles, double evenness, Execution& execution) const;
  const std::vector<int>& missing() const { return missing_; }  ///< #V, of the cones
  /// Turns the UVs of polygons until v runs up on most.
  void turn_upright(TurnedMap& map, const Along& along) const;

 private:
  std::vector<NearestMap::Rounded> nearest(double tiles) const;
  uv::UvArray coordinates(const Eigen::VectorXcd& y, const NearestMap::Rounded& rounded) const;
  // The frames turned as one to be level, with those that are pulled.
  Frames levelled(Frames frames, const ConeOptions& options) const;
  // The strain of a map in the plane, with what is minded of rows that are not level.
  double strain(const uv::UvArray& laid, double evenness, Execution& execution) const;
  Eigen::VectorXcd evened(Eigen::VectorXcd y, const NearestMap::Rounded& rounded, double evenness,
                          Execution& execution) const;
  uv::Kept kept() const;

  std::shared_ptr<const mesh::Surface> surface_;
  Net net_;
  std::vector<int> missing_;
  Frames frames_;
  TurnedSpace space_;
  NearestMap nearest_;
  std::optional<Along> along_;
};

}  // namespace holomorph::tiling
