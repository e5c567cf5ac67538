// The result of maps of disks to the plane.
#pragma once

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

#include "structure/options.h"
#include "structure/solver_report.h"

namespace holomorph::plane {

using structure::Options;

/// One fixed map of a disk to the plane, continuous everywhere.
struct PlaneMap {
  Eigen::VectorXcd points;                   ///< #V
  std::vector<int> corners;                  ///< four vertices of a rectangle
  double modulus = 0, lower = 0, upper = 0;  ///< height over width of a rectangle, and its bounds
  Eigen::VectorXd scale_factors;  ///< #V of a map with free boundary: length in the plane over that on the surface
  std::vector<int> collapsed_triangles;  ///< triangles all of whose corners lie on one side of a rectangle
  double harmonicity = 0;                ///< largest |L f| at a free vertex over the largest sum of its terms
  double mollification = 0;
  double metric = 0;  ///< as in structure::Certificate
  int flip_count = 0;
  structure::SolverReport solver;
  std::vector<std::pair<std::string, double>> seconds;
};

}  // namespace holomorph::plane
