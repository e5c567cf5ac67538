// The harmonic forms of a structure on the triangles that UVs are drawn on.
#pragma once

#include <memory>

#include "base/execution.h"
#include "structure/options.h"
#include "structure/structure.h"

namespace holomorph::structure {

/// Invariants are sharpest on the intrinsic Delaunay triangulation. But its functions are linear on other triangles
/// than the surface's own, so UVs may collapse or flip across a sliver. The functions here are those of the same
/// classes with the least conformal energy on the surface's own triangles. Where the intrinsic functions come within
/// 1e-9 of that (relative; their energy on the surface's triangles bounds the gain from above), and where no edge was
/// flipped, they are taken as they are. Each call may throw SolverError and Cancelled, and may be made again.
class UvForms {
 public:
  virtual ~UvForms() = default;

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
std::unique_ptr<UvForms> uv_forms(const Structure& structure, const Options& options);

}  // namespace holomorph::structure
