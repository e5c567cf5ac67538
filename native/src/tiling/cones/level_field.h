// Fields of k directions on the triangles, as smooth as can be and pulled level.
#pragma once

#include <array>
#include <vector>

#include "tiling/cones/net.h"

namespace holomorph::tiling {

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

/// The field z, one number of length 1 a triangle, whose k-th roots are k directions of u. It minimises its differences
/// across edges and its distance from level, weighted by how steep a triangle is: (A + weight W) z = weight W q. At
/// lines of the net u or v runs along them. @throws SolverError
std::vector<Complex> level_field(const Net& net, const std::vector<std::array<double, 3>>& points, int k,
                                 const Along& along, double weight);

/// Turns directions, angles of u on the triangles, towards level, but for k-th turns: by the delta that lowers
/// |d delta|^2 + weight times the integral of steepness sin(k (angle - level) / 2)^2, from 0 on. Continuous: what they
/// turn by across edges and around vertices stays the same. @param angle #T, changed. @throws SolverError
void pull_level(const Net& net, const std::vector<std::array<double, 3>>& points, int k, const Along& along,
                double weight, std::vector<double>& angle);

/// The cones of a field: how it turns on the way around a vertex. @return #V, k-th turns that are missing
std::vector<int> cones_of_field(const Net& net, const std::vector<Complex>& field, int k);

/// The weight of the difference of a field, or of frames, across a side.
double dual_weight(const Net& net, int side);

}  // namespace holomorph::tiling
