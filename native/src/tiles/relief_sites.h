// What a relief knows of vertices and corners: where they are, and by what they are moved.
#pragma once

#include <Eigen/Core>
#include <array>

namespace holomorph::tiles {

/// The quantities at a vertex that are interpolated linearly on every triangle.
struct ReliefSite {
  Eigen::Vector3d position;
  Eigen::Vector3d normal;  ///< by which a height of 1 moves the surface, over the depth
  double share = 1;  ///< factor of the height; 0 at all vertices of triangles at poles, where UVs do not fit together
};

/// The normals at the corners of a triangle, each of the smooth part of the surface around it: across a sharp edge they
/// differ. Elsewhere they are those of the vertices.
using CornerNormals = std::array<Eigen::Vector3d, 3>;

/// What the corners of a triangle have of the smooth part around them.
struct SmoothCorners {
  CornerNormals normals;
  std::array<bool, 3> are_reflex{};  ///< it takes more than half of the vertex's surroundings
};

}  // namespace holomorph::tiles
