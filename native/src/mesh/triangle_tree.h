// A tree of triangles for the nearest point of a surface, and the plane of symmetry found with it.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <span>
#include <utility>
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

  /// Finds the triangle nearest to a point, and its distance; of several, the first along the curve of `spatial_order`.
  /// Cost: O(log #T) near the surface
  std::pair<int, double> nearest(const Eigen::Vector3d& point) const;

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

struct MirrorPlane {
  Eigen::Vector3d point, normal;  ///< |normal| = 1

  double height(const Eigen::Vector3d& p) const { return normal.dot(p - point); }
  Eigen::Vector3d image(const Eigen::Vector3d& p) const { return p - 2 * height(p) * normal; }
};

/// Finds the plane through the centroid in which images of vertices are nearest to the surface. Its normal is an axis
/// of space, or an axis of inertia of the area. None where an image is farther from the surface than a hundredth of the
/// root of the area.
/// @param tree of the surface. @pre the surface has positions. Cost: O(#T)
std::optional<MirrorPlane> mirror_plane(const Surface& surface, const TriangleTree& tree);

}  // namespace holomorph::mesh
