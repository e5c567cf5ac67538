// Homology basis (paper § 4.2), the cohomology basis dual to it (paper § 5) and a canonical basis, in exact integers.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "topology/fundamental_domain.h"
#include "topology/integer_forms.h"

namespace holomorph::topology {

using IntegerMatrix = Eigen::Matrix<std::int64_t, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// 2g closed loops zeta_i as half-edges one behind the other: e_i in its own direction, closed through T. The stretch
/// that both paths to the root share is left out; it is walked to and fro.
std::vector<std::vector<HalfedgeHandle>> homology_basis(const HalfEdges& half_edges, const FundamentalDomain& domain);

/// 2g closed integer forms eta_i with eta_i(zeta_j) = delta_ij: the signed number of times an edge is crossed by the
/// dual loop that closes e_i in D. Leaving a face through a half-edge counts +1 along it. The paper's § 5 recursion
/// gives a form of the same class; this one is its special case with all free choices 0.
IntegerForms cohomology_basis(const HalfEdges& half_edges, const FundamentalDomain& domain);

/// Appends b - 1 classes: the signed crossings of the dual path that enters through e_k, runs in D and leaves through
/// e_0, k = 1 .. b-1. The period of class k over boundary loop k, the hole on its left, is 1, over loop 0 it is -1,
/// over the other loops and over the zeta 0.
void add_paths_between_loops(const HalfEdges& half_edges, const FundamentalDomain& domain, IntegerForms& forms);

/// Appends b - 1 classes of H^1(M, dM): d(1 on loop k, 0 at all other vertices), k = 1 .. b-1. Any triangulation on the
/// same vertices.
void add_loop_indicators(const HalfEdges& half_edges, const mesh::BoundaryLoops& boundary, IntegerForms& forms);

/// W_ij = int a_i ^ b_j of closed integer forms, b zero along the boundary: it depends on the classes only, and is an
/// integer.
IntegerMatrix pairing(const HalfEdges& half_edges, const IntegerForms& a, const IntegerForms& b);

/// W_ij = int eta_i ^ eta_j, integer because both are classes of integers; exact on any triangulation they live on.
IntegerMatrix wedge_matrix(const HalfEdges& half_edges, const IntegerForms& forms, Execution& execution);

/// Rows S with S W S^T = J = [[0, I], [-I, 0]], |det S| = 1: integer symplectic Gram-Schmidt.
/// @param W antisymmetric, |det| 1. @throws holomorph::Error if an entry leaves 64 bits
IntegerMatrix symplectic_basis(const IntegerMatrix& W);

struct CanonicalBasis {
  IntegerMatrix intersection;  ///< zeta_i . zeta_j = -W^-1
  IntegerMatrix cycles;        ///< R: rows a_1..a_g, b_1..b_g written in the zeta; R intersection R^T = J
  IntegerMatrix classes;       ///< S = R^-T: rows alpha_1..alpha_g, beta_1..beta_g written in the eta
};

CanonicalBasis canonical_basis(const IntegerMatrix& wedge);

}  // namespace holomorph::topology
