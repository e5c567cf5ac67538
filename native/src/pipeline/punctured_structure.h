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

/// Of a closed surface of genus g with punctures. Forms: theta_0 with the residues r_i / (2 pi i) at the punctures and
/// real periods for real residues, then the g holomorphic forms. All of it belongs to the artist's triangulation, its
/// diagonals turned away from the punctures: there are no invariants to sharpen, and the stars stay the artist's.
struct PuncturedStructure {
  mesh::Surface surface;  ///< with the diagonals turned
  mesh::HalfEdges half_edges;
  Punctures punctures;
  std::vector<mesh::Star> stars;
  topology::IntegerForms classes;  ///< 2g of the handles, then one for each puncture but the last
  uv::CornerSheets sheets;         ///< of all classes
  std::vector<int> seams;          ///< the cut graph with its ends at the punctures, and all spokes
  forms::ClosedForms harmonic;     ///< 2g forms, dual to the handles' loops
  Eigen::MatrixXcd periods;        ///< 2g x g: of the holomorphic forms
  Eigen::VectorXcd at_vertex;      ///< #V: u + i v of theta_0 without its classes; meaningless at the punctures
  Eigen::VectorXcd handle_part;    ///< 2g: coefficients of the harmonic forms in theta_0
  forms::Residuals residuals;
  double period_residual = 0;  ///< largest |int over a link - residue|, relative to the residue
  double mollification = 0;
  SolverReport solver;
  std::vector<std::pair<std::string, double>> seconds;
};

/// @param punctures none on a surface of genus 0: two far apart are taken; no residues: the default ones
/// @pre connected, no isolated vertices
/// @throws TopologyError for a boundary, or punctures or residues that do not fit; SolverError; Cancelled
PuncturedStructure punctured_structure(const mesh::Surface& surface, Punctures punctures, const Options& options,
                                       Progress& progress);

/// #C x 2: UVs of sum_j c_j theta_j. In the stars of the punctures see uv::place_apexes.
/// @param c 1 + g complex coefficients
uv::UvArray uv_map(const PuncturedStructure& structure, const Eigen::VectorXcd& c);

/// (1 + g) x #E values of the forms along half-edge 2e; NaN for theta_0 on the spokes, where it is infinite.
Eigen::MatrixXcd edge_values(const PuncturedStructure& structure);

}  // namespace holomorph::pipeline
