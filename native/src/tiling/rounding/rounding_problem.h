// The rounding problem of a form with poles.
#pragma once

#include "tiling/inversion/abel_jacobi.h"
#include "tiling/poles/meromorphic_form.h"
#include "tiling/rounding/rounding.h"

namespace holomorph::tiling {

/// X = n + i m + sum_i r_i C_i are the periods of a form besides its poles; n + i m and r_i are points of the lattice.
/// * Closed: X = sum_j c_j theta_j + t_j conj(theta_j) in cohomology, g defects t.
/// * With boundary, free loops (planar): c = X. No defects: every rounding is conformal.
/// * With boundary, straight loops: c = Re X over all loops, r real; the defects are what the v-periods of the 2g
///   handles lack, t = Im(n + i m) - C#^T c, as multiples of the Dirichlet forms of the handles whose loop periods,
///   which are free, have least energy.
/// @param parts #loops x k: C_i; closed: against the last pole, whose residue is the rest
/// @param greens with those of the poles
/// @param jacobian of a closed surface with handles, else null. @throws Cancelled
RoundingProblem rounding_problem(const MeromorphicForm& form, const GreensFunctions& greens, uv::Coefficients kind,
                                 const TextureLattice& lattice, const MatrixXd& parts, const Jacobian* jacobian,
                                 Execution& execution);

}  // namespace holomorph::tiling
