// Gram matrices of closed forms, with a bound of all rounding.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "base/execution.h"
#include "forms/closed_forms.h"
#include "mesh/half_edges.h"

namespace holomorph::forms {

/// G_ij = sum_e k_e h_i(e) h_j(e), exactly the L2 products of the piecewise constant forms.
struct GramMatrix {
  Eigen::MatrixXd value;
  Eigen::MatrixXd uncertain;  ///< the same sums with the errors of the weights in place of the weights
  Eigen::VectorXd size;       ///< sum_e (|k_e| + |u_e|) h_i(e)^2, u the errors of the weights
  Eigen::VectorXd cut_size;   ///< sum_e (|k_e| + |u_e|) eta_i(e)^2, eta_i the integer class
  int summands = 0;           ///< additions that one product goes through, at most
};

/// Computes the Gram matrix of each family of forms. Sums go over blocks of edges in a fixed order, so that the bits do
/// not depend on the number of threads. Blocks without weights cost nothing.
/// @param errors mesh::energy_errors, or none: then only `value` is set
/// @param families numbers of forms of consecutive families. @return one for each
std::vector<GramMatrix> gram_matrices(const mesh::HalfEdges& half_edges, std::span<const double> weights,
                                      std::span<const double> errors, const ClosedForms& forms,
                                      const std::vector<int>& families, Execution& execution);

/// Bounds the rounding: returns a positive definite matrix E with G_exact <= value + E as quadratic forms. G_exact has
/// the energies on the surface as given, of the forms eta_i + d f_i with f_i as stored. E bounds all errors together:
/// those of the weights, of differences of functions and of the sums in any order.
Eigen::MatrixXd gram_errors(const GramMatrix& gram);

}  // namespace holomorph::forms
