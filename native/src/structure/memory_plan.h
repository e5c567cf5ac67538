// How many harmonic forms are solved for at a time, and whether all of them are kept, within a limit of memory.
#pragma once

#include <cstdint>

#include "mesh/components.h"
#include "solver/solver_choice.h"
#include "structure/options.h"

namespace holomorph::structure {

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

}  // namespace holomorph::structure
