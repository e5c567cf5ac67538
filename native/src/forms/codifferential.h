// The codifferential of integer classes: the right-hand sides of the harmonic forms (paper Eq. 5, Eq. 8).
#pragma once

#include <Eigen/Core>
#include <span>

#include "base/workers.h"
#include "forms/closed_forms.h"

namespace holomorph::forms {

/// Computes -d* eta_i = -d^T (k eta_i), #V x #forms: the right-hand sides of Eq. 8.
Eigen::MatrixXd codifferentials(const mesh::EdgeEnds& ends, std::span<const double> weights,
                                const topology::IntegerForms& classes, Workers& workers);

/// The same for the classes first .. first + count - 1 alone, #V x count.
Eigen::MatrixXd codifferentials(const mesh::EdgeEnds& ends, std::span<const double> weights,
                                const topology::IntegerForms& classes, int first, int count, Workers& workers);

/// The same for real combinations of the classes: column j for sum_i combinations(i, j) eta_i, #V x #combinations.
Eigen::MatrixXd codifferentials(const mesh::EdgeEnds& ends, std::span<const double> weights,
                                const topology::IntegerForms& classes, const Eigen::MatrixXd& combinations,
                                Workers& workers);

/// The same for any forms, given by their values along half-edges 2e, #E x #forms.
Eigen::MatrixXd codifferentials(const mesh::EdgeEnds& ends, std::span<const double> weights,
                                const RowMajorMatrix& edge_values, Workers& workers);

/// Computes <eta_i, h_j> = sum_e k_e eta_i(e) h_j(e), #classes x #forms. Where d* h_j = 0, <df_i, h_j> = 0 and so <h_i,
/// h_j> = <eta_i, h_j>: one form h_j at a time is enough for a Gram matrix. With the residual r_j = L f_j + d* eta_j of
/// its system it is <h_i, h_j> + f_i . r_j.
Eigen::MatrixXd class_products(const mesh::EdgeEnds& ends, std::span<const double> weights,
                               const topology::IntegerForms& classes, const ClosedForms& forms);

}  // namespace holomorph::forms
