// The harmonic forms of a structure on the triangles that UVs are drawn on.
#pragma once

#include <memory>

#include "base/execution.h"
#include "structure/solver_report.h"
#include "structure/structure.h"

namespace holomorph::structure {

/// Invariants are sharpest on the intrinsic Delaunay triangulation. But its functions are linear on other triangles
/// than the surface's own, so UVs may collapse or flip across a sliver. The functions here are those of the same
/// classes with the least conformal energy on the surface's own triangles. Where the intrinsic functions come within
/// 1e-9 of that (relative; their energy on the surface's triangles bounds the gain from above), and where no edge was
/// flipped, they are taken as they are. Each call may throw SolverError and Cancelled, and may be made again.
class PrimalForms {
 public:
  virtual ~PrimalForms() = default;

  /// Prepares what all calls below need. Optional: they do so themselves.
  virtual void prepare(Execution& execution) = 0;
  /// Returns sum_k p_k f_k, #V x 2: real and imaginary part.
  virtual uv::UvArray function(const Eigen::VectorXcd& p, Execution& execution) = 0;
  /// Writes the values of all forms of the basis on the edges, #forms x #E.
  virtual void write_edge_values(Eigen::Ref<forms::RowMajorMatrix> rows, Execution& execution) = 0;
  /// Returns the samples of the harmonic forms that the balanced map is found from.
  virtual uv::FormSamples samples(Execution& execution) = 0;
  /// How the forms were solved for.
  const SolverReport& solver() const { return report_; }

 protected:
  SolverReport report_;
};

/// The UV forms of a structure, whose functions are shared. Where its plan keeps no forms, each call solves for what it
/// is asked for, and keeps the factor or hierarchy for the next. Samples are those of the intrinsic triangulation.
/// @param structure,options outlive the result
std::unique_ptr<PrimalForms> primal_forms(const Structure& structure, const Options& options);

/// Returns one coefficient for each differential. Without poles: those of uv::balanced_coefficients, real on a surface
/// with boundary, scaled so that the UV area of the surface is 1. With poles: theta_0 alone, so that its residues stay.
/// @throws SolverError, Cancelled
Eigen::VectorXcd balanced_coefficients(const Structure& structure, PrimalForms& forms, Execution& execution);

/// Computes the UVs of sum_j c_j theta_j, #C x 2 in the order of polygons.corner_vertices.
/// @param c one coefficient of each column of `structure.differentials`; real on a surface with boundary, so that
/// boundaries stay straight
/// @throws SolverError, Cancelled
uv::UvArray uv_map(const Structure& structure, PrimalForms& forms, const Eigen::VectorXcd& c, Execution& execution);

struct BalancedMap {
  Structure structure;
  Eigen::VectorXcd coefficients;  ///< coefficients of its differentials
  uv::UvArray uv;                 ///< #C x 2
};

/// Computes the conformal structure, balanced coefficients and UVs of any connected surface. A sphere or a disk gets
/// the poles that pole_structure takes by itself, and its log map; flat/dirichlet_problem.h maps a disk to the round
/// one.
/// @pre connected, no isolated vertices (mesh::component makes it so)
/// @throws TopologyError for a sphere or a disk too small for its poles; SolverError; Cancelled
BalancedMap balanced_map(std::shared_ptr<const mesh::Surface> surface, const Options& options, Execution& execution);

}  // namespace holomorph::structure
