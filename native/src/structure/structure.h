// The conformal structure of a surface: harmonic forms, differentials made of them, and the conformal invariants.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/execution.h"
#include "conformal/holomorphic_basis.h"
#include "forms/certificates.h"
#include "structure/memory_plan.h"
#include "structure/puncture_choice.h"
#include "structure/solver_report.h"
#include "structure/topology.h"
#include "uv/balance.h"
#include "uv/uv_map.h"

namespace holomorph::structure {

/// Errors of the solution, relative; see the functions that measure them.
struct Certificate {
  forms::Residuals residuals;  ///< of all forms, on the triangulation that was solved on
  double periods = 0;    ///< largest |int_{zeta_i} h_j - delta_ij|; with punctures also |int over a link - residue|
  double pairing = 0;    ///< with boundary: largest |int h^N_i ^ h - (W c)_i| of one h = sum_j c_j h^D_j
  double asymmetry = 0;  ///< of the Gram matrix of streamed forms before it was made symmetric
  double metric =
      0;  ///< largest part of itself by which the energy of a form on a triangle may grow, for rounding; 1: open
};

/// Of one connected surface of any kind: closed with handles, with boundary, with punctures. What a kind has not is
/// empty. A differential is a column of complex coefficients of the real harmonic forms, so that UVs, values on edges
/// and balance are the same few products for all kinds.
struct Structure {
  std::shared_ptr<const mesh::Surface> surface;  ///< diagonals that ended at punctures are flipped
  Topology topology;
  Punctures punctures;
  std::vector<mesh::Star> stars;  ///< of the punctures

  forms::RowMajorMatrix functions;  ///< #V x #forms f_j of the basis eta_j + d f_j, on the triangulation that was
                                    ///< solved on; none if streamed, or once UvForms has taken them over
  Eigen::MatrixXcd differentials;  ///< #forms x n: with punctures theta_0 of the chosen residues, then holomorphic ones

  /// #natural x #poles: C, with omega_i = d(u_i - sum_j C_ji h_j) + i dv_i
  Eigen::MatrixXd pole_parts;

  std::vector<Eigen::MatrixXd> gram;          ///< of the natural and, with boundary, of the Dirichlet forms
  std::vector<Eigen::MatrixXd> certain_gram;  ///< certainly not below those of the surface; for the bounds
  conformal::HolomorphicBasis holomorphic;    ///< of the natural and Dirichlet forms

  Certificate certificate;
  SolverReport solver;
  MemoryPlan memory;
  uv::FormSamples samples;   ///< of streamed forms
  double mollification = 0;  ///< added to some lengths; with 0 `gram` is of the surface's metric
  int flip_count = 0;        ///< of the intrinsic Delaunay triangulation
  std::vector<std::pair<std::string, double>> seconds;  ///< per stage
};

/// #V x 2, #C x 2: the UVs of the real and imaginary part of sum_k p_k h_k, from its function sum_k p_k f_k. Triangles
/// of the stars of punctures have an apex each (uv/apexes.h).
/// @throws SolverError where a UV is not finite
void write_uv_map(const Structure& structure, const uv::UvArray& function, const Eigen::VectorXcd& p,
                  Eigen::Ref<uv::UvArray> corners, Workers& workers);

/// UV area of the surface under sum_k p_k h_k, a holomorphic form: with real part r its energy <r, r>.
double uv_area(const Structure& structure, const Eigen::VectorXcd& p);

/// Takes the sheets of the caller's own cut, polygon edges; the spokes of punctures are cut in any case.
/// @param names what a vertex is called in messages; empty: its index
/// @throws TopologyError where the map still jumps elsewhere
void cut_along(Structure& structure, std::vector<int> edges, const std::vector<int>& names, Execution& execution);

/// The edges between punctures and their links, ascending.
std::vector<int> spokes(const Structure& structure);

}  // namespace holomorph::structure
