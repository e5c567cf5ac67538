// A tree of triangles, for rays and boxes that meet them.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <span>
#include <vector>

#include "mesh/surface.h"

namespace holomorph::mesh {

/// Sorts the points' indices along a Z-order curve through their bounding cube (Morton 1966), so that near points are
/// near in the order. Points in one cell, of 2^-21 of the cube's side, keep the order of their numbers.
/// Cost: linear.
std::vector<int> spatial_order(const std::vector<std::array<double, 3>>& points);

class TriangleTree {
 public:
  /// @pre there are positions, which are copied, and a triangle. Cost: O(#T log #T)
  explicit TriangleTree(const Surface& surface) : TriangleTree(surface.polygons.vertices, surface.triangles) {}
  TriangleTree(std::span<const std::array<double, 3>> vertices, std::span<const Triple> triangles);

  /// Whether a ray, of any length, meets a triangle farther than `begin` times the direction from where it starts.
  bool meets(const Eigen::Vector3d& start, const Eigen::Vector3d& direction, double begin) const;

  /// Appends the triangles that may meet a box: those of leaves whose boxes do.
  void find_near(const Eigen::AlignedBox3d& box, std::vector<int>& found) const;

 private:
  struct Node {
    Eigen::AlignedBox3d box;
    int first, end;  // its triangles, as places in order_
  };
  using Corners = std::array<Eigen::Vector3d, 3>;

  void build(std::size_t node, int first, int end);

  std::vector<int> order_;        // triangles, near ones near each other
  std::vector<Corners> corners_;  // in that order
  std::vector<Node> nodes_;       // children of node n: 2 n + 1 and 2 n + 2
};

}  // namespace holomorph::mesh
