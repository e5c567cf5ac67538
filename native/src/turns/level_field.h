// Fields of k directions on the triangles, as smooth as can be and pulled level.
#pragma once

#include <array>
#include <vector>

#include "turns/net.h"

namespace holomorph::turns {

/// The k-th power of the direction of u on each triangle that is level: at right angles to `up`, the surface on the
/// left of what runs up; and the square of the sine between the triangle's normal and `up`. 1 and 0 where flat.
struct Level {
  std::vector<Complex> direction;  ///< #T, of length 1, in the plane of the triangle
  std::vector<double> steepness;   ///< #T
};
Level level_directions(const Net& net, const std::vector<std::array<double, 3>>& points,
                       const std::array<double, 3>& up);

/// The cones of the field z that minimises its differences across edges and its distance from level, weighted by how
/// steep a triangle is: (A + weight W) z = weight W q. @return #V, k-th turns that are missing
/// @throws SolverError
std::vector<int> cones_of_field(const Net& net, const std::vector<std::array<double, 3>>& points, int k,
                                const std::array<double, 3>& up, double weight);

}  // namespace holomorph::turns
