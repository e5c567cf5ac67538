// The rounding problem of a form with poles.
#pragma once

#include <optional>

#include "tiling/inversion/abel_jacobi.h"
#include "tiling/poles/meromorphic_form.h"
#include "tiling/poles/mirror.h"
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

/// Restricts the problem to integers with mirrored residues: those of images are conjugate, up to the sign that a
/// quarter turn of the texture brings. None where the lattice is not its own mirror image, or where the given phase is
/// no multiple of a quarter turn: a direction in space counts more than the mirror. Without a phase the symmetry is u
/// -> -u.
/// @param options the same; changed to the quarter turn, and to more sizes
std::optional<RoundingProblem> mirrored(const RoundingProblem& problem, const std::vector<int>& poles,
                                        const Mirror& mirror, RoundingOptions& options);

}  // namespace holomorph::tiling
