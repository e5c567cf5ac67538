#include "solver/multigrid/hierarchy.h"

#include "solver/multigrid/interpolation.h"
#include "solver/multigrid/level_operators.h"

namespace holomorph::solver {
namespace {

// Coarsening ends at this size, where applying a dense inverse takes about 30 us.
constexpr int kCoarsest = 250;
// Coarsening also ends if a step leaves more than this part of the vertices: such a graph has no strong edges.
constexpr double kSlowest = 0.9;
// The largest dense inverse, where coarsening ended early.
constexpr int kLargestDense = 2000;
// Entries of a row of P, finest level and below: the fewest that keep the number of iterations.
constexpr int kFinestEntries = 2, kCoarseEntries = 3;

Array<char> fixed_flags(int n, const std::vector<int>& fixed) {
  if (fixed.empty()) return {};
  Array<char> flags(n);
  std::fill(flags.begin(), flags.end(), 0);
  for (const int v : fixed) flags[v] = 1;
  return flags;
}

// The order of the loops over a level. The last of those up may write what the one before reads, so that it needs both
// directions: of two entries w_ij and w_ji of a matrix symmetric up to rounding one may be 0.
void order_loops(Level& level, Workers& workers) {
  const int chunks = row_chunks(level.rows());
  const ChunkNeeds needs_A = chunk_needs(level.op.A, kChunkRows, chunks, workers);
  const ChunkNeeds needs_R = chunk_needs(level.R, coarse_rows_per_chunk(level), chunks, workers);
  level.down = Wavefront(chunks, {needs_R}, workers.count());
  level.up = Wavefront(chunks, {needs_A, symmetrised(needs_A)}, workers.count());
}

}  // namespace

Hierarchy make_hierarchy(const Laplacian& L, const std::vector<int>& fixed, Execution& execution) {
  Hierarchy result;
  std::vector<Level>& levels = result.levels;
  levels.push_back({finest_operator(L, fixed_flags(L.size(), fixed), execution), {}, {}, {}, {}});
  while (levels.back().rows() > kCoarsest) {
    Level& fine = levels.back();
    const Coarsening coarse = coarsening(fine.op);
    if (coarse.count > kSlowest * fine.rows()) break;
    fine.P = interpolation(fine.op, coarse, levels.size() == 1 ? kFinestEntries : kCoarseEntries, execution);
    fine.R = transposed(fine.P, coarse.count);
    Operator next = coarse_operator(fine.op, coarse, fine.P, fine.R, execution);
    // Only coarsening and interpolation need it.
    fine.op.largest = {};
    order_loops(fine, execution.workers());
    levels.push_back({std::move(next), {}, {}, {}, {}});
  }
  if (levels.back().rows() > kLargestDense) {
    throw SolverError("the multigrid hierarchy of a system of " + std::to_string(L.size()) + " unknowns ends at " +
                      std::to_string(levels.back().rows()));
  }
  result.coarsest = coarsest_inverse(levels.back().op);
  return result;
}

}  // namespace holomorph::solver
