// The map that is shown first: its coefficients, its UVs, and all of it in one call.
#pragma once

#include <memory>

#include "base/execution.h"
#include "structure/options.h"
#include "structure/primal_forms.h"
#include "structure/structure.h"

namespace holomorph::structure {

/// Returns one coefficient for each differential. Without poles: those of uv::balanced_coefficients, real on a surface
/// with boundary, scaled so that the UV area of the surface is 1. With poles: theta_0 alone, so that its residues stay.
/// @throws SolverError, Cancelled
Eigen::VectorXcd balanced_coefficients(const Structure& structure, UvForms& forms, Execution& execution);

/// Computes the UVs of sum_j c_j theta_j, #C x 2 in the order of polygons.corner_vertices.
/// @param c one coefficient of each column of `structure.differentials`; real on a surface with boundary, so that
/// boundaries stay straight
/// @throws SolverError, Cancelled
uv::UvArray uv_map(const Structure& structure, UvForms& forms, const Eigen::VectorXcd& c, Execution& execution);

struct BalancedMap {
  Structure structure;
  Eigen::VectorXcd coefficients;  ///< coefficients of its differentials
  uv::UvArray uv;                 ///< #C x 2
};

/// Computes the conformal structure, balanced coefficients and UVs of any connected surface. A sphere or a disk gets
/// the poles that pole_structure takes by itself, and its log map; plane/disk_map.h maps a disk to the round one.
/// @pre connected, no isolated vertices (mesh::component makes it so)
/// @throws TopologyError for a sphere or a disk too small for its poles; SolverError; Cancelled
BalancedMap balanced_map(std::shared_ptr<const mesh::Surface> surface, const Options& options, Execution& execution);

}  // namespace holomorph::structure
