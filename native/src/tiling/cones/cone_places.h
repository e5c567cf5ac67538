// Where cones may be: the vertices among which they are searched for.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "mesh/surface.h"
#include "tiling/cones/net.h"

namespace holomorph::tiling {

/// Cones lie inside a patch, and holes at their places.
class ConePlaces {
 public:
  /// @param patch #V, the patch of each vertex, below 0 where no cone may be; empty: one patch
  /// @pre the surface and the net outlive this
  ConePlaces(const mesh::Surface& surface, const Net& net, std::vector<int> patch);

  bool have_patches() const { return have_patches_; }
  int patch(int v) const { return patch_[v]; }
  bool is_hole(int v) const { return net_.hole[v] == v; }
  bool is_place(int v) const;
  double squared_distance(int v, int w) const;

  /// The vertices where a function is extreme, the most extreme ones; holes; and farthest points, with these `count` or
  /// a few more. @param function #V
  std::vector<int> spread(const Eigen::VectorXd& function, int count) const;
  /// Places whose squared distance is below this.
  std::vector<int> within(int v, double squared) const;
  /// For each of these vertices, those of them that are nearer than this, ascending; holes are near to none.
  std::vector<std::vector<std::size_t>> near(const std::vector<int>& vertices, double squared) const;

 private:
  const std::vector<std::array<double, 3>>& points_;
  const Net& net_;
  std::vector<int> patch_;
  const bool have_patches_;
};

}  // namespace holomorph::tiling
