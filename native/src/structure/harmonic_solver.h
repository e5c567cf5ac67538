// The linear systems of harmonic forms on one discretisation: L f_j = -d* eta_j (paper § 6, Eq. 8).
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "base/execution.h"
#include "forms/closed_forms.h"
#include "forms/refined_solver.h"
#include "mesh/components.h"
#include "mesh/delaunay.h"
#include "mesh/double_cover.h"
#include "mesh/surface.h"
#include "solver/laplace_solver.h"
#include "solver/solver_choice.h"
#include "structure/solver_report.h"

namespace holomorph::structure {

// How many harmonic forms are solved for at a time, and whether all of them are kept, within a limit of memory.

/// Forms are kept up to this memory of their functions if no limit is set: 2 GB.
inline constexpr std::int64_t kKeptBytes = 2'000'000'000;

/// The size of one computation.
struct Extent {
  std::int64_t vertices = 0, edges = 0, forms = 0;
};

/// How a computation keeps within a limit of memory.
struct MemoryPlan {
  /// Whether all functions stay in memory, #V x #forms numbers. Otherwise each block is dropped once it has been
  /// measured.
  bool keep_forms = true;
  int block = 0;  ///< right-hand sides solved for at a time
  /// Upper estimate of the memory in use at once, beside the surface itself. It is at most 2.5 times as much as is
  /// used, plus 30 MB for small surfaces.
  std::int64_t bytes = 0;
  solver::Choice choice;      ///< a solver that fits
  solver::Choice map_choice;  ///< a solver for a single map of forms that are not kept
};

/// Whether a computation can do with a few forms at a time.
enum class Keeping { all, as_many_as_fit };

/// Plans a computation. Without a limit the forms are kept up to kKeptBytes of functions, and nothing is refused but
/// thousands of forms on a small mesh, beyond 1 GB and 100 kB for each vertex. With a limit they are kept where all
/// fits, otherwise solved for in blocks of the largest size that fits. The direct solver, where it was not asked for by
/// name, gives way to multigrid if its factor does not fit.
/// @throws SolverError if not even two right-hand sides fit, or not all where all must be kept, naming the bytes
MemoryPlan plan_memory(const Extent& extent, const Options& options, Keeping keeping);

/// Plans for all harmonic forms of a surface, on its double where the options say so, before anything large is made.
/// Those of a surface with boundary are kept.
MemoryPlan plan_memory(const mesh::Surface& surface, const mesh::TopologicalType& type, const Options& options,
                       Keeping keeping);

/// @throws SolverError where `what`, e.g. "the 4 harmonic forms on 300 edges", takes more than a limit that is set
void require_memory(const std::string& what, std::int64_t bytes, std::int64_t memory_limit);

struct DoubledSurface {
  mesh::DoubleCover cover;
  Array<double> weights;  ///< #E of the double, those of the surface: edges of the boundary count twice
};

DoubledSurface doubled(const mesh::Discretisation& surface, Execution& execution);

/// Extends classes to the double: the first `natural` ones symmetrically, the others antisymmetrically.
topology::IntegerForms extended(const mesh::HalfEdges& half_edges, const mesh::DoubleCover& cover,
                                const topology::IntegerForms& classes, int natural);

/// Computes (f(v) + f(v*)) / 2 for the first `natural` functions, (f(v) - f(v*)) / 2 for the others, v* the dual vertex
/// (Eq. 12): #V of the surface x #forms.
forms::RowMajorMatrix symmetrised(const forms::RowMajorMatrix& functions, const mesh::DoubleCover& cover, int natural);

/// Set up before the classes are known. With Boundary::double_cover every form is solved for on the closed double.
/// Natural classes are extended symmetrically, Dirichlet classes antisymmetrically. The solutions are symmetrised (Eq.
/// 12) and restricted to the surface. They are those of the surface to solver accuracy, at twice the size.
class HarmonicSolver {
 public:
  /// @param plan made for this discretisation, or for its double
  /// @pre the discretisation outlives this. @throws SolverError, Cancelled
  HarmonicSolver(const mesh::Discretisation& discretisation, MemoryPlan plan, Boundary boundary, Execution& execution);

  using MakeSolver = std::function<std::unique_ptr<solver::LaplaceSolver>(solver::Laplacian&&)>;
  /// Uses the solver that `make` returns for the Laplacian of the surface, or of its double.
  HarmonicSolver(const mesh::Discretisation& discretisation, MemoryPlan plan, Boundary boundary, const MakeSolver& make,
                 Execution& execution);

  /// Plans memory for this many right-hand sides, all of them kept.
  HarmonicSolver(const mesh::Discretisation& discretisation, int right_hand_sides, const Options& options,
                 Execution& execution);

  /// Receives the functions of the forms first, first + 1, ..., #V x #block.
  using TakeFunctions = std::function<void(int first, forms::RowMajorMatrix&& functions)>;

  /// Solves for as many forms at a time as the plan says, in order, and hands each block on.
  /// @param classes on the discretisation. @param natural number of natural ones, which come first; the others are
  /// Dirichlet
  /// @throws SolverError, Cancelled
  void solve_in_blocks(const topology::IntegerForms& classes, int natural, Execution& execution,
                       const TakeFunctions& take);
  /// The functions of all classes, #V x #forms.
  forms::RowMajorMatrix solve(const topology::IntegerForms& classes, int natural, Execution& execution);

  const mesh::Discretisation& discretisation() const { return discretisation_; }
  const MemoryPlan& plan() const { return plan_; }
  /// The linear systems, for other right-hand sides. With Boundary::double_cover they are those of the double.
  forms::RefinedSolver& systems() { return systems_; }
  SolverReport report() const { return solver_report(systems_); }

 private:
  const mesh::HalfEdges& half_edges() const { return double_ ? double_->cover.half_edges : discretisation_.half_edges; }
  std::span<const double> weights() const { return double_ ? double_->weights : discretisation_.weights; }

  const mesh::Discretisation& discretisation_;
  MemoryPlan plan_;
  std::unique_ptr<const DoubledSurface> double_;  // what is solved on instead
  forms::RefinedSolver systems_;
};

struct LaplaceProblem {
  std::vector<std::array<int, 2>> ends;  ///< ends of the edges of the intrinsic Delaunay triangulation
  Array<double> weights;                 ///< weights of these edges: (L x)_i = sum_j w_ij (x_i - x_j)
  std::unique_ptr<solver::LaplaceSolver> solver;
  int threads = 0;  ///< threads of the execution that made it
};

/// @param fixed vertices, at 0 for right-hand sides with the condition dirichlet
/// @throws SolverError, Cancelled
LaplaceProblem laplace_problem(const mesh::Surface& surface, const std::vector<int>& fixed, const Options& options,
                               Execution& execution);

}  // namespace holomorph::structure
