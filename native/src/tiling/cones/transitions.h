// How the directions of a turned map continue across edges: the connection with the wanted cones, and its cut.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "tiling/cones/net.h"
#include "tiling/cones/scale_form.h"

namespace holomorph::tiling {

/// A flat metric with cones, its log scale u and its directions: frame theta on each triangle, so that u of the map
/// runs at the angle theta in the triangle's plane. Frames continue across edges but for turns.
struct Frames {
  Eigen::VectorXd scale;      ///< #V, u
  std::vector<double> angle;  ///< #T, theta
  std::vector<double> level;  ///< #T, theta pulled level, which whole numbers are rounded for as well; empty for none
  /// #sides: across a cut edge x' = R^turn x + translation, from the triangle to the twin's; -1 for an edge that is not
  /// cut
  std::vector<int> turn;
};

/// @param missing #V, cones (cones.h). @throws SolverError
Frames make_frames(const mesh::Surface& surface, const Net& net, int k, const std::vector<int>& missing);

/// The log scale u of the flat metric with these cones.
Eigen::VectorXd log_scale(const Net& net, Laplace& laplace, int k, const std::vector<int>& missing);

/// Makes the turns of frames 0 across a tree of triangles, and finds the cut.
/// @param angle #T; changed by k-th turns. @param turned #sides, k-th turns from the triangle to the twin's; changed
/// @return Frames::turn. @throws SolverError turns are left elsewhere than on the cut
std::vector<int> cut_frames(const mesh::Surface& surface, const Net& net, int k, const std::vector<int>& missing,
                            std::vector<double>& angle, std::vector<int>& turned);

}  // namespace holomorph::tiling
