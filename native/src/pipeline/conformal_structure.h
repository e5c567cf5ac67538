// The whole method in its order (paper § 4 to § 9): read conformal_structure.cpp first.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "conformal/holomorphic_basis.h"
#include "pipeline/harmonic_forms.h"
#include "pipeline/paper_levels.h"
#include "topology/carried_classes.h"
#include "uv/corner_sheets.h"
#include "uv/uv_map.h"

namespace holomorph::pipeline {

/// Everything known about the conformal structure of one closed connected surface of genus g >= 1.
struct ConformalStructure {
  std::vector<std::vector<mesh::HalfedgeHandle>> homology_basis;  ///< 2g loops zeta_i
  topology::CanonicalBasis canonical;
  forms::ClosedForms harmonic;  ///< dual to zeta: classes on the artist's edges, functions as solved; none if streamed
  Eigen::MatrixXd gram_matrix;
  conformal::HolomorphicBasis holomorphic;
  std::vector<int> seams;  ///< edges of the cut graph
  uv::CornerSheets sheets;
  forms::Residuals residuals;  ///< on the intrinsic triangulation
  double period_residual = 0;  ///< largest |int_{zeta_i} h_j - delta_ij|
  double asymmetry = 0;        ///< of the Gram matrix of streamed forms before it was made symmetric, relative
  MemoryPlan memory;
  uv::FormSamples samples;   ///< of streamed forms
  double mollification = 0;  ///< added to every edge length
  int flip_count = 0;        ///< of the intrinsic Delaunay triangulation
  SolverReport solver;
  std::vector<std::pair<std::string, double>> seconds;  ///< per stage
};

/// @param given the loops zeta and their dual classes, as carried from another level of a progressive mesh; by default
/// they are found on the surface
/// @param levels for the paper's solver, whose loops and classes are always those of the base mesh: a progressive mesh
/// that there is already; by default it is made here. The paper's solver turns no edges: all that is computed belongs
/// to the artist's triangulation
/// @pre connected, no isolated vertices (mesh::component makes it so)
/// @throws TopologyError for genus 0 or a boundary, naming both; SolverError; Cancelled
ConformalStructure conformal_structure(const mesh::Surface& surface, const Options& options, Execution& execution,
                                       std::optional<topology::DualBases> given = {},
                                       std::optional<PaperLevels> levels = {});

}  // namespace holomorph::pipeline
