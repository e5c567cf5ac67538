// Disks with three edges on their boundary and no room for a centre.
#pragma once

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/harmonic_forms.h"

namespace holomorph::pipeline {

/// The harmonic map whose boundary is the triangle with the lengths of the three edges, its longest side 1. A single
/// triangle goes to itself.
struct TriangleMap {
  Eigen::VectorXcd
      points;              ///< #V, counter-clockwise, the lowest boundary vertex at 0 and the next one on the real axis
  double harmonicity = 0;  ///< largest |L z| at an inner vertex over the largest sum of its terms
  double mollification = 0;
  SolverReport solver;
  std::vector<std::pair<std::string, double>> seconds;
};

/// @pre a disk
/// @throws TopologyError for a boundary of more than three edges; SolverError; Cancelled
TriangleMap triangle_map(const mesh::Surface& surface, const Options& options, Execution& execution);

}  // namespace holomorph::pipeline
