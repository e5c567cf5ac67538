// The harmonic forms of a structure on the triangles that UVs are drawn on.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

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

// A structure with the forms that its maps are made of, shared by several callers.

/// The forms are solved for when first asked for, and used by one caller at a time.
struct Solved {
  Options options;
  int threads = 0;  ///< as it was asked for, see `Execution`
  Structure value;
  std::mutex mutex;
  std::atomic<std::thread::id> user;   ///< the thread that uses the forms
  std::unique_ptr<PrimalForms> forms;  ///< none of a structure that was cut
  std::shared_ptr<Solved> uncut;       ///< where this was cut: the one whose forms it shares

  /// Calls use(forms). A call from within the progress function of another, on the same thread, would wait for itself:
  /// it gets forms of its own.
  template <class Use>
  void with_forms(const Use& use) {
    Solved& owner = uncut ? *uncut : *this;
    if (owner.user == std::this_thread::get_id()) return use(*primal_forms(owner.value, owner.options));
    const std::lock_guard<std::mutex> one_at_a_time(owner.mutex);
    owner.user = std::this_thread::get_id();
    const std::unique_ptr<Solved, void (*)(Solved*)> end(&owner, [](Solved* used) { used->user = std::thread::id(); });
    use(*owner.forms);
  }
};

/// @param compute(options, execution) the structure
template <class Compute>
std::shared_ptr<Solved> solved(const Options& options, Execution& execution, const Compute& compute) {
  auto made = std::make_shared<Solved>();
  made->options = options;
  made->threads = execution.threads();
  made->value = compute(options, execution);
  made->forms = primal_forms(made->value, made->options);
  return made;
}

}  // namespace holomorph::structure
