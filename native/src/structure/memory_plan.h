// How many harmonic forms are solved for at a time, and whether all of them are kept, within a limit of memory.
#pragma once

#include <cstdint>

#include "solver/solver_choice.h"

namespace holomorph::structure {

/// Functions of forms that are kept without being asked for less: 2 GB.
inline constexpr std::int64_t kKeptBytes = 2'000'000'000;

/// The size of one computation.
struct Extent {
  std::int64_t vertices = 0, edges = 0, forms = 0;
};

struct MemoryPlan {
  bool keep_forms =
      true;       ///< all functions stay in memory, #V x #forms numbers; else each block goes when it was measured
  int block = 0;  ///< right-hand sides solved for at a time
  std::int64_t bytes = 0;  ///< estimate of the most memory in use at once, beside the surface itself: at least that,
                           ///< and up to 2.5 times, of small surfaces 30 MB more
  solver::Choice choice;   ///< of the solver: one that fits
};

/// Whether a computation can do with a few forms at a time.
enum class Keeping { all, as_many_as_fit };

/// Without a limit the forms are kept up to kKeptBytes of functions, and nothing is refused. With one they are kept
/// where all fits, else solved for in blocks of the largest size that fits; the direct solver, where it was not asked
/// for by name, gives way to multigrid if its factor does not fit.
/// @param solver "auto", "direct", ...; @param memory_limit bytes, 0 for none
/// @throws SolverError if not even two right-hand sides fit, or not all where all must be kept, naming the bytes
MemoryPlan plan_memory(const Extent& extent, const std::string& solver, std::int64_t memory_limit, Keeping keeping);

/// @throws SolverError where `what`, e.g. "the 4 harmonic forms on 300 edges", takes more than a limit that is set
void require_memory(const std::string& what, std::int64_t bytes, std::int64_t memory_limit);

}  // namespace holomorph::structure
