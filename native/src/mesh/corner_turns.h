// Values at corners, such as UVs, whose two sides of an edge differ by a turn and a translation: x' = R^r x + t.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mesh/surface.h"

namespace holomorph::mesh {

/// The turns by 2 pi / k, in the coordinates of the values.
class TurnGroup {
 public:
  TurnGroup() : TurnGroup(1, Eigen::Matrix2d::Identity()) {}
  /// @param turn by 2 pi / k
  TurnGroup(int k, const Eigen::Matrix2d& turn);
  /// In coordinates of the lattice whose symmetry they are, where they are integers. @param k 1, 2, 4 or 6
  static TurnGroup of_lattice(int k);
  /// In the plane. @param k as above
  static TurnGroup of_plane(int k);

  int order() const { return static_cast<int>(powers_.size()); }
  int reduced(int r) const { return (r % order() + order()) % order(); }
  /// The r-th power, also for negative r.
  const Eigen::Matrix2d& power(int r) const { return powers_[reduced(r)]; }

 private:
  std::vector<Eigen::Matrix2d> powers_;
};

/// Corner i of triangle t, and the side that leaves it, is 3 t + i.
class CornerTurns {
 public:
  CornerTurns() = default;
  /// Each edge turns by the r for which its two sides are nearest to each other.
  /// @param values #C x 2. Cost: linear; nothing for k = 1
  CornerTurns(const Surface& surface,
              const Eigen::Ref<const Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>>& values,
              const TurnGroup& group);

  /// r across a side, from its triangle to the one beyond; 0 on the boundary.
  int across(int side) const { return across_.empty() ? 0 : across_[side]; }
  /// r from the first corner at a vertex, in the order of the triangles, to this one.
  int at_corner(int corner) const { return corner_.empty() ? 0 : corner_[corner]; }
  /// r all around a vertex: not 0 at a cone.
  int around(int vertex) const { return around_.empty() ? 0 : around_[vertex]; }

 private:
  std::vector<signed char> across_, corner_, around_;  // #sides, #corners, #V
};

}  // namespace holomorph::mesh
