// The conformal map of a closed surface of genus 0 to the sphere.
#pragma once

#include "pipeline/punctured_structure.h"

namespace holomorph::pipeline {

using PointArray = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// #V x 3 points of the unit sphere, orientation kept: z = exp(2 pi i (u + iv)) of residue 1 is 0 at the first puncture
/// and infinite at the second; inverse stereographic projection takes them to (0, 0, 1) and (0, 0, -1), after a scaling
/// of z for which the mean height over the surface's area is 0.
/// @throws TopologyError for another genus or number of punctures
PointArray sphere_map(const PuncturedStructure& structure);

}  // namespace holomorph::pipeline
