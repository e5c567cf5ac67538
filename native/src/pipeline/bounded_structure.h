// The method on a surface with boundary, on the surface itself instead of its double (paper § 8).
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "conformal/bounded_basis.h"
#include "pipeline/bounded_forms.h"
#include "uv/corner_sheets.h"

namespace holomorph::pipeline {

/// Everything known about the conformal structure of one connected surface of genus g with b >= 1 boundary loops,
/// n = 2g + b - 1 >= 1. The symmetric forms of the double are the natural forms, the antisymmetric ones the Dirichlet
/// forms; the star exchanges them, so that the double itself is not needed.
struct BoundedStructure {
  mesh::BoundaryLoops boundary;
  std::vector<std::vector<mesh::HalfedgeHandle>> homology_basis;  ///< n loops: 2g zeta_i, then boundary loops 1 .. b-1
  topology::IntegerMatrix pairing;  ///< W_ij = int h^N_i ^ h^D_j = [[J_h, 0], [X, 1]], |det| 1
  forms::ClosedForms harmonic;      ///< 2n: h^N, dual to the loops, then h^D; classes on the artist's edges
  Eigen::MatrixXd natural_gram, dirichlet_gram;
  conformal::BoundedBasis holomorphic;
  std::vector<int> seams;                ///< interior edges of the cut graph
  std::vector<int> collapsed_triangles;  ///< triangles all of whose corners lie on one loop
  uv::CornerSheets sheets;               ///< of the 2n classes
  forms::Residuals residuals;            ///< on the intrinsic triangulation, both families
  double period_residual = 0;            ///< largest |int_{zeta_i} h^N_j - delta_ij|
  double pairing_residual = 0;  ///< largest |int h^N_i ^ h - (W c)_i| of one h = sum_j c_j h^D_j, all c = 1, -1
  double mollification = 0;     ///< added to every edge length
  int flip_count = 0;           ///< of the intrinsic Delaunay triangulation
  SolverReport solver;
  std::vector<std::pair<std::string, double>> seconds;  ///< per stage
};

/// @pre connected, no isolated vertices (mesh::component makes it so)
/// @throws TopologyError for a closed surface or a disk, naming genus and boundary count; SolverError; Cancelled
BoundedStructure bounded_structure(const mesh::Surface& surface, const Options& options, Execution& execution);

}  // namespace holomorph::pipeline
