// Differentials of the third kind, theta = du + i dv with residues s / (2 pi i) at punctures (paper § 11 names them).
//
// No face is cut out. In the stars the singular part (singular_part.h) is known; outside it goes on as any closed form
// with the same values on the links, and u = u_s + df, v = v_s + g with f, g on all vertices of the whole mesh:
//
//     L f = -d^T (k u_s) + b_u,   L g = -d^T (k d v_s) + b_v      (d^T over the faces outside the stars)
#pragma once

#include <span>
#include "forms/harmonic_basis.h"
#include "forms/singular_part.h"

namespace holomorph::forms {

/// u_s outside the stars: d(part.u) + sum_i residues(i) n_i.
struct Singularities {
  SingularPart part;
  topology::IntegerForms classes;  ///< n_i of the stars (topology::puncture_classes)
  Eigen::MatrixXd residues;        ///< #stars x m reals; on a closed surface each column sums to 0
  Array<double> outer_weights;     ///< #E
};

/// The form of u is d(u) + sum_i residues(i) n_i outside the stars; v is single-valued.
struct ThirdKind {
  Eigen::MatrixXd u, v;    ///< #V x m; at the punctures only f and g
  double harmonicity = 0;  ///< largest residual of the equations at a vertex over the largest sum of |terms|
};

/// @param weights #E, of the triangulation that `solver` solves on
/// @param held the vertices that the solver can hold: all of the boundary, where v = 0 and u is natural; none on a
/// closed surface
/// @return pairs whose u has the periods of the classes: where there are harmonic forms not yet conjugate, see
/// harmonic_part. Cost: 2 m solves. @throws SolverError, Cancelled
ThirdKind third_kind(const mesh::HalfEdges& half_edges, std::span<const double> weights,
                     const Singularities& singularities, solver::LaplaceSolver& solver, const std::vector<int>& held,
                     Execution& execution);

/// C, #forms x m: u - sum_j C_j h_j is orthogonal to all h_j, as the conjugate of a single-valued v is.
/// C = G^-1 P, P_j = <u_s, h_j> over the faces outside the stars - b_u . (values of h_j measured from the puncture).
/// @param harmonic,gram_matrix on the same triangulation; with boundary the natural forms, of all classes
Eigen::MatrixXd harmonic_part(const mesh::HalfEdges& half_edges, const Singularities& singularities,
                              const std::vector<mesh::Star>& stars, const ClosedForms& harmonic,
                              const Eigen::MatrixXd& gram_matrix);

}  // namespace holomorph::forms
