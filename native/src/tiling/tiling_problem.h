// The rounding of a form with poles, in the bases of a landscape.
#pragma once

#include "tiling/landscape.h"
#include "tiling/leverage.h"
#include "tiling/poles.h"
#include "tiling/rounding.h"

namespace holomorph::tiling {

/// X = n + i m + sum_i r_i C_i are the periods of a form besides its poles; n + i m and r_i are points of the lattice.
/// * Closed: X = sum_j c_j theta_j + t_j conj(theta_j) in cohomology, g defects t.
/// * With boundary, free loops (planar): c = X. No defects: every rounding is conformal.
/// * With boundary, straight loops: c = Re X over all loops, r real; the defects are what the v-periods of the 2g
///   handles lack, t = Im(n + i m) - C#^T c, as multiples of the Dirichlet forms of the handles whose loop periods,
///   which are free, have least energy.
/// @param parts #loops x k: C_i; closed: against the last pole, whose residue is the rest
/// @param leverage of a closed surface with handles, else null
RoundingProblem tiling_problem(Landscape& landscape, const Poles& poles, uv::Coefficients kind,
                               const TextureLattice& lattice, const Eigen::MatrixXd& parts, const Leverage* leverage,
                               Execution& execution);

/// #samples x k: the pole columns of the problem.
Eigen::MatrixXcd pole_forms(Landscape& landscape, const std::vector<int>& vertices, Execution& execution);

/// Residues of all poles from the k free ones.
Eigen::VectorXcd all_residues(const Landscape& landscape, std::size_t poles, const Eigen::VectorXcd& free);

}  // namespace holomorph::tiling
