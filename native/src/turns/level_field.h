// Fields of k directions on the triangles, as smooth as can be and pulled level.
#pragma once

#include <array>
#include <vector>

#include "turns/net.h"

namespace holomorph::turns {

/// A vector in space that v runs along, so that rows are level where it is up, or u does.
struct Along {
  std::array<double, 3> vector;
  bool is_of_u = false;
};

/// The direction of u on each triangle for that, and the square of the sine between the triangle's normal and the
/// vector: 1 and 0 where these are one.
struct Level {
  std::vector<Complex> direction;  ///< #T, of length 1, in the plane of the triangle
  std::vector<double> steepness;   ///< #T
};
Level level_directions(const Net& net, const std::vector<std::array<double, 3>>& points, const Along& along);

/// The cones of the field z that minimises its differences across edges and its distance from level, weighted by how
/// steep a triangle is: (A + weight W) z = weight W q. @return #V, k-th turns that are missing
/// @throws SolverError
std::vector<int> cones_of_field(const Net& net, const std::vector<std::array<double, 3>>& points, int k,
                                const Along& along, double weight);

}  // namespace holomorph::turns
