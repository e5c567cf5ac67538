// By how much forms miss being harmonic, where weights are so large that rounding hides it.
#pragma once

#include <Eigen/Core>
#include <span>

#include "base/workers.h"
#include "forms/closed_forms.h"
#include "mesh/half_edges.h"

namespace holomorph::forms {

struct HarmonicResiduals {
  Eigen::MatrixXd R;            ///< #V x #forms, -d* (eta + d f)
  Eigen::RowVectorXd energies;  ///< #forms, <h, h>
};

/// Those of the classes first, first + 1, ... with these functions. The flux of each edge, k (f_i - f_j + eta),
/// takes the differences first, and is summed in twice the working precision: with k = 1e8 fluxes of 1e-8
/// remain, of which b - L f has no digit. At fixed vertices R is the flux through the boundary.
/// Cost: about ten products with L, in parallel; the bits do not depend on the number of threads.
HarmonicResiduals harmonic_residuals(const mesh::HalfEdges& half_edges, std::span<const double> weights,
                                     const topology::IntegerForms& classes, int first, const RowMajorMatrix& functions,
                                     Workers& workers);

}  // namespace holomorph::forms
