// Harmonic forms h_i = eta_i + d f_i (paper § 6).
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "base/execution.h"
#include "forms/laplacian.h"
#include "mesh/edge_ends.h"
#include "solver/laplace_solver.h"
#include "topology/integer_forms.h"

namespace holomorph::forms {

using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// A family of closed forms eta_i + d f_i, kept as classes and functions: #forms numbers per vertex instead of per
/// edge. Where memory is short, only some of the functions are there at a time, and #forms below counts those.
struct ClosedForms {
  topology::IntegerForms classes;
  RowMajorMatrix functions;  ///< #V x #forms, of the classes first, first + 1, ...
  int first = 0;
};

/// -d* eta_i = -d^T (k eta_i), #V x #forms: the right-hand sides of Eq. 8.
Eigen::MatrixXd codifferentials(const mesh::EdgeEnds& ends, std::span<const double> weights,
                                const topology::IntegerForms& classes, Workers& workers);

/// The same for the classes first .. first + count - 1 alone, #V x count.
Eigen::MatrixXd codifferentials(const mesh::EdgeEnds& ends, std::span<const double> weights,
                                const topology::IntegerForms& classes, int first, int count, Workers& workers);

/// The same for real combinations of the classes: column j for sum_i combinations(i, j) eta_i, #V x #combinations.
Eigen::MatrixXd codifferentials(const mesh::EdgeEnds& ends, std::span<const double> weights,
                                const topology::IntegerForms& classes, const Eigen::MatrixXd& combinations,
                                Workers& workers);

/// The harmonic form of each class: L f_i = -d* eta_i, all right-hand sides in one block. With the Dirichlet condition
/// f_i = 0 at the solver's held vertices, and d* h_i need not vanish there.
ClosedForms harmonic_basis(const mesh::EdgeEnds& ends, std::span<const double> weights,
                           const topology::IntegerForms& classes, solver::LaplaceSolver& solver,
                           solver::Condition condition, Execution& execution);

/// Values of all forms on the edges begin .. end-1, (end - begin) x #forms, along half-edge 2e.
RowMajorMatrix edge_values(const mesh::EdgeEnds& ends, const ClosedForms& forms, int begin, int end);

/// G_ij = sum_e k_e h_i(e) h_j(e): exactly the L2 products of the piecewise constant forms.
/// Summed in a fixed order of blocks of edges, so the bits do not depend on the number of threads.
Eigen::MatrixXd gram_matrix(const mesh::HalfEdges& half_edges, std::span<const double> weights,
                            const ClosedForms& forms, Execution& execution);

/// <h_i, h_i> on the artist's triangles: the diagonal of gram_matrix there, summed by triangles in a fixed order.
/// @param mollification added to every length. Cost: #T x #forms
Eigen::VectorXd energies(const mesh::Surface& surface, double mollification, const ClosedForms& forms,
                         Execution& execution);

/// <eta_i, h_j> = sum_e k_e eta_i(e) h_j(e), #classes x #forms: the columns of the Gram matrix that belong to these
/// forms. Where d* h_j = 0, <df_i, h_j> = 0 and so <h_i, h_j> = <eta_i, h_j>: one form h_j at a time is enough.
/// With the residual r_j = L f_j + d* eta_j of its system it is <h_i, h_j> + f_i . r_j.
Eigen::MatrixXd class_products(const mesh::EdgeEnds& ends, std::span<const double> weights, const ClosedForms& forms);

/// Relative maxima over all forms: |sum of a form around a face| over its largest value; |d* h| at a vertex over the
/// largest sum of |k h| at a vertex.
/// @param held vertices at which the functions are prescribed, so that d* h need not vanish there
struct Residuals {
  double closedness = 0, harmonicity = 0;
};
Residuals residuals(const mesh::HalfEdges& half_edges, std::span<const double> weights, const ClosedForms& forms,
                    Execution& execution, const std::vector<int>& held = {});

/// Values of one combination sum_j c_j h_j on all edges, #E along half-edge 2e.
Eigen::VectorXd combination(const mesh::EdgeEnds& ends, const ClosedForms& forms, const Eigen::VectorXd& c);

/// int h_i ^ w over the surface for all forms h_i and one form w, #E values along half-edge 2e; summed in a fixed
/// order.
Eigen::VectorXd wedges(const mesh::HalfEdges& half_edges, const ClosedForms& forms, const Eigen::VectorXd& w,
                       Execution& execution);

/// Integrals of the forms over closed loops of half-edges, #loops x #forms.
Eigen::MatrixXd periods(const mesh::EdgeEnds& ends, const ClosedForms& forms,
                        const std::vector<std::vector<mesh::HalfedgeHandle>>& loops);

/// The paper's averaged star (§ 7): on each edge the mean over its two faces of the face-wise star. Not closed, so it
/// has no well-defined integral; for comparison only. @param form,result #E values along half-edge 2e
std::vector<double> averaged_star(const mesh::HalfEdges& half_edges, std::span<const double> lengths,
                                  const std::vector<double>& form);

}  // namespace holomorph::forms
