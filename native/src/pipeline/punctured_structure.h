// Surfaces with punctures: a differential of the third kind, and the holomorphic forms besides (paper § 11 names them).
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "conformal/holomorphic_basis.h"
#include "forms/third_kind.h"
#include "pipeline/harmonic_forms.h"
#include "pipeline/puncture_choice.h"
#include "uv/apexes.h"
#include "uv/corner_sheets.h"

namespace holomorph::pipeline {

/// Of a surface of genus g with b boundary loops and punctures. theta_0 has the residues r_i / (2 pi i) at the
/// punctures; for real residues v is single-valued and 0 on the boundary. On a closed surface g holomorphic forms come
/// after it. All of it belongs to the artist's triangulation, its diagonals turned away from the punctures: there are
/// no invariants to sharpen, and the stars stay the artist's.
struct PuncturedStructure {
  mesh::Surface surface;  ///< with the diagonals turned
  mesh::HalfEdges half_edges;
  Punctures punctures;
  std::vector<mesh::Star> stars;
  bool closed = true;
  topology::IntegerForms classes;  ///< n of the harmonic forms, then topology::puncture_classes
  uv::CornerSheets sheets;         ///< of all classes
  std::vector<int> seams;          ///< the cut graph with its ends at the punctures, and all spokes
  forms::ClosedForms harmonic;     ///< n = 2g, or 2g + b - 1 natural forms
  Eigen::MatrixXcd periods;        ///< n x g: of the holomorphic forms; n x 0 with boundary
  Eigen::VectorXcd at_vertex;      ///< #V: u + i v of theta_0 without its classes; meaningless at the punctures
  Eigen::VectorXcd handle_part;    ///< n coefficients of the harmonic forms in theta_0
  forms::Residuals residuals;
  double period_residual = 0;  ///< largest |int over a link - residue|, relative to the residue
  double mollification = 0;
  SolverReport solver;
  std::vector<std::pair<std::string, double>> seconds;
};

/// @param punctures none: two far apart are taken on a closed surface, the deepest vertex on one with boundary; no
/// residues: the default ones
/// @pre connected, no isolated vertices
/// @throws TopologyError for punctures or residues that do not fit; SolverError; Cancelled
PuncturedStructure punctured_structure(const mesh::Surface& surface, Punctures punctures, const Options& options,
                                       Execution& execution);

/// #C x 2: UVs of sum_j c_j theta_j. In the stars of the punctures see uv::place_apexes.
/// @param c 1 + periods.cols() complex coefficients
uv::UvArray uv_map(const PuncturedStructure& structure, const Eigen::VectorXcd& c, Workers& workers);

/// (1 + periods.cols()) x #E values of the forms along half-edge 2e; NaN for theta_0 on the spokes, where it is
/// infinite.
Eigen::MatrixXcd edge_values(const PuncturedStructure& structure);

/// #V: z = exp(2 pi i (u + iv)) of a disk with one puncture of residue 1, the Riemann map to the unit disk: 0 at the
/// puncture, |z| = 1 on the boundary. @pre such a structure
Eigen::VectorXcd disk_map(const PuncturedStructure& structure);

}  // namespace holomorph::pipeline
