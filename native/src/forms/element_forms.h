// Harmonic forms of given integer classes by elements of order p. A polyhedral surface is flat inside its triangles, so
// nothing else is approximated: h = eta + d f, f a continuous function, on each triangle a polynomial of degree p.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/execution.h"
#include "forms/closed_forms.h"
#include "forms/gram_matrices.h"
#include "forms/reference_element.h"
#include "mesh/half_edges.h"
#include "mesh/metric_errors.h"
#include "solver/laplace_solver.h"

namespace holomorph::forms {

/// An estimate of the memory that ElementForms::solve takes, as measured and rounded up, in bytes.
double bytes(double faces, int order, int forms);

class ElementForms {
 public:
  /// @param weights of each face, from its half-edge on
  /// @param natural number of natural classes, which come first; the others are Dirichlet
  /// @pre half-edges and classes outlive this
  ElementForms(const mesh::HalfEdges& half_edges, std::vector<mesh::FaceWeights> weights,
               const topology::IntegerForms& classes, int natural, int order);

  /// Solves for the functions f of all forms: #U x #forms, the coefficients of ReferenceElement's basis on sides, p - 1
  /// for each edge along half-edge 2e, then the values at vertices, then what is inside, for each face.
  /// The inside is eliminated face by face, what is left is factorised.
  /// @throws SolverError, Cancelled
  forms::RowMajorMatrix solve(Execution& execution) const;

  /// Measures forms with any functions: admissible ones, whatever they are, if Dirichlet ones are 0 on the boundary.
  /// One for each family; forms::gram_errors bounds their errors, as those of forms that are constant on triangles.
  std::vector<forms::GramMatrix> gram_matrices(const forms::RowMajorMatrix& functions, Execution& execution) const;

  /// Numbers of faces whose sum is the trace of the relative width of the bounds, tr G^-1 (G - W G'^-1 W^T), up to
  /// rounding. That width is the energy of *h_i - sum_j C_ij h'_j with the C that makes it least: a sum over faces, and
  /// so tells where it comes from.
  std::vector<double> gaps(const forms::RowMajorMatrix& functions, const std::vector<Eigen::MatrixXd>& gram,
                           Execution& execution) const;

 private:
  struct Condensed;
  struct System {
    solver::Laplacian L;
    Eigen::MatrixXd B;
  };
  using Stiffness = std::array<double, 3>;

  /// Unknowns of the linear system.
  Eigen::Index unknowns() const { return vertex_begin() + static_cast<Eigen::Index>(half_edges_.n_vertices()); }

  int faces() const { return static_cast<int>(half_edges_.n_faces()); }
  Eigen::Index vertex_begin() const { return static_cast<Eigen::Index>(half_edges_.n_edges()) * reference_.of_side(); }
  std::vector<int> fixed_unknowns() const;
  std::vector<int> families() const;
  std::array<mesh::HalfedgeHandle, 3> sides(int face) const;
  Eigen::MatrixXd combined(const Stiffness& weights, bool absolute = false) const;
  Eigen::MatrixXd class_values(int face) const;
  Condensed condensed(int face) const;
  System assembled(Execution& execution) const;
  Eigen::MatrixXd outer_values(int face, const forms::RowMajorMatrix& functions) const;
  Eigen::MatrixXd values(int face, const forms::RowMajorMatrix& functions) const;
  std::vector<Eigen::Index> outer_unknowns(int face, Eigen::VectorXd& signs) const;

  const mesh::HalfEdges& half_edges_;
  std::vector<mesh::FaceWeights> weights_;
  const topology::IntegerForms& classes_;
  int natural_;
  const ReferenceElement& reference_;
};

}  // namespace holomorph::forms
