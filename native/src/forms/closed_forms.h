// Closed one-forms eta + df, and their codifferentials.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "base/workers.h"
#include "mesh/half_edges.h"
#include "topology/homology.h"

namespace holomorph::forms {

using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// A family of closed forms eta_i + d f_i as a view of classes and functions: #forms numbers per vertex instead of per
/// edge. Where memory is short, only a block of the functions is present at a time, and #forms below counts those.
/// @pre classes and functions outlive this
struct ClosedForms {
  const topology::IntegerForms& classes;
  const RowMajorMatrix& functions;  ///< #V x #forms, for the classes first, first + 1, ...
  int first = 0;
};

/// Returns the values of all forms on the edges begin .. end-1, (end - begin) x #forms, along half-edge 2e.
RowMajorMatrix edge_values(const mesh::EdgeEnds& ends, const ClosedForms& forms, int begin, int end);

/// Writes the values of all forms on all edges, #forms x #E.
void write_edge_values(const mesh::EdgeEnds& ends, const ClosedForms& forms, Eigen::Ref<RowMajorMatrix> rows);

/// Returns the values of one combination sum_j c_j h_j on all edges, #E along half-edge 2e.
Eigen::VectorXd combination(const mesh::EdgeEnds& ends, const ClosedForms& forms, const Eigen::VectorXd& c);

/// Integrates the forms over closed loops of half-edges, #loops x #forms.
Eigen::MatrixXd periods(const mesh::EdgeEnds& ends, const ClosedForms& forms,
                        const std::vector<std::vector<mesh::HalfedgeHandle>>& loops);

/// Returns the largest |int_{loop i} h_j - delta_ij| over the first #loops classes, as far as their functions are
/// present.
double period_residual(const mesh::EdgeEnds& ends, const ClosedForms& forms,
                       const std::vector<std::vector<mesh::HalfedgeHandle>>& loops);

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
