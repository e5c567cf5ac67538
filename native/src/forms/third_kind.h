// Differentials of the third kind, theta = du + i dv with residues s / (2 pi i) at poles (paper § 11 names them).
//
// No face is cut out. In the stars the singular part is known. Outside, it is continued as any closed
// form with the same values on the links. Then u = u_s + df and v = v_s + g, with f and g on all vertices of the mesh:
//
//     L f = -d^T (k u_s) + b_u,   L g = -d^T (k d v_s) + b_v      (d^T over the faces outside the stars)
#pragma once

#include <Eigen/SparseCore>
#include <span>
#include <vector>

#include "base/execution.h"
#include "base/page_allocator.h"
#include "forms/closed_forms.h"
#include "forms/refined_solver.h"
#include "mesh/stars.h"

namespace holomorph::forms {

/// The singular part in the star of a pole. Near a pole of residue 1 and total angle Theta, in polar coordinates (r,
/// alpha) of its star, u_s = alpha/Theta and v_s = -log(r)/Theta: u_s + i v_s = 1 / (2 pi i) log z with z = (r e^(i
/// alpha))^(2 pi/Theta).
///
/// b_u, b_v are the fluxes of u_s, v_s out of the star through its link, tested with the hat functions. They contain a
/// second term, which makes the result second order: the difference between u_s, v_s and their linear interpolants on
/// the straight link edges, tested with the normal derivatives of the hat functions. Each column of b_u sums to 0,
/// each of b_v to 1; both test linear functions exactly.
struct StarPart {
  std::vector<double> u, v;      ///< at the end of each link edge; u jumps by 1 at link[0]
  std::vector<double> b_u, b_v;  ///< the same
  double b_u_at_pole = 0, b_v_at_pole = 0;
};

/// @param lengths #E
StarPart star_part(const mesh::HalfEdges& half_edges, std::span<const double> lengths, const mesh::Star& star);

/// The parts of several stars, as columns.
struct SingularPart {
  Eigen::SparseMatrix<double> u, v;      ///< #V x #stars, supported on the links; u jumps by 1 at the link edge link[0]
  Eigen::SparseMatrix<double> b_u, b_v;  ///< #V x #stars, supported on the stars
};

/// @param lengths #E
SingularPart singular_part(const mesh::HalfEdges& half_edges, std::span<const double> lengths,
                           const std::vector<mesh::Star>& stars);

/// Returns the weights k over the faces outside the stars: 0 on spokes; on link edges, the part of the outer face.
Array<double> outer_weights(const mesh::HalfEdges& half_edges, std::span<const double> lengths, Array<double> weights,
                            const std::vector<mesh::Star>& stars);

/// m pole forms, each with the residue 1 at a pole of its own. Outside the stars u_s = d(part.u residues) +
/// classes.
struct PoleForms {
  std::vector<mesh::Star> stars;
  Eigen::MatrixXd residues;  ///< #stars x m: the identity with boundary; closed, each column has -1 at the last star,
                             ///< so that it sums to 0
  topology::IntegerForms classes;  ///< m classes, from topology::pole_classes
  SingularPart part;
  Array<double> outer_weights;  ///< #E, of SingularPart
};

/// Returns the residues of the pole forms, #stars x m.
Eigen::MatrixXd pole_residues(Eigen::Index stars, bool closed);

/// The form of u is d(u) + classes outside the stars; v is single-valued.
struct PoleFunctions {
  RowMajorMatrix u, v;     ///< #V x m; at the poles only f and g
  double harmonicity = 0;  ///< largest residual of the equations at a vertex over the largest sum of |terms|
};

/// @param weights #E, of the triangulation that `solver` solves on
/// @param fixed the vertices that the solver can fix: all of the boundary, where v = 0 and u is natural; none on a
/// closed surface
/// @return pairs whose u has the periods of the classes. Where there are harmonic forms, u and v are not conjugate yet:
/// see harmonic_part. Cost: 2 m solves. @throws SolverError, Cancelled
PoleFunctions pole_functions(const mesh::HalfEdges& half_edges, std::span<const double> weights, const PoleForms& poles,
                             RefinedSolver& solver, const std::vector<int>& fixed, Execution& execution);

/// Solves for the function of sum_j p_j h_j + sum_i r_i (u_i + i v_i): its real and imaginary part, #V x 2. On a closed
/// surface this is the only form with these periods and residues. The form is its differential + the same sum of the
/// classes.
/// @param natural classes of the h_j, on the triangulation that `solver` solves on
/// @param p #natural, r #poles
/// Cost: 2 solves. @throws SolverError, Cancelled
RowMajorMatrix function_with_poles(const mesh::HalfEdges& half_edges, std::span<const double> weights,
                                   const PoleForms& poles, const topology::IntegerForms& natural,
                                   const Eigen::VectorXcd& p, const Eigen::VectorXcd& r, RefinedSolver& solver,
                                   Execution& execution);

/// Computes C, #forms x m, such that u - sum_j C_j h_j is orthogonal to all h_j, as the conjugate of a single-valued v
/// is.
/// C = G^-1 P, P_j = <u_s, h_j> over the faces outside the stars - b_u . (values of h_j measured from the pole).
/// @param harmonic,gram_matrix on the same triangulation; with boundary the natural forms, the first of `harmonic`
Eigen::MatrixXd harmonic_part(const mesh::HalfEdges& half_edges, const PoleForms& poles, const ClosedForms& harmonic,
                              const Eigen::MatrixXd& gram_matrix);

/// Computes the same where weights are large, from the u that were solved for, #V x m. Outside the stars <u_s, h_j> =
/// <u, h_j>, because <df, h_j> = 0. In this sum over all edges, both factors of a product are small where the weight is
/// large.
Eigen::MatrixXd harmonic_part(const mesh::HalfEdges& half_edges, std::span<const double> weights,
                              const PoleForms& poles, const RowMajorMatrix& u, const ClosedForms& harmonic,
                              const Eigen::MatrixXd& gram_matrix);

}  // namespace holomorph::forms
