// The plane in which a surface is its own mirror image.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "mesh/triangle_tree.h"

namespace holomorph::mesh {

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
