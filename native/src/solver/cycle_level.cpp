#include "solver/cycle_level.h"

#include <algorithm>

namespace holomorph::solver {
namespace {

// Also those that a chunk is needed by: of two entries w_ij and w_ji of a matrix symmetric up to rounding one may be 0.
Needs both_ways(const Needs& needs) {
  Needs result = needs;
  for (int chunk = 0; chunk < static_cast<int>(needs.size()); ++chunk) {
    for (const int c : needs[chunk]) {
      const bool known = std::find(needs[c].begin(), needs[c].end(), chunk) != needs[c].end();
      if (!known) result[c].push_back(chunk);
    }
  }
  return result;
}

}  // namespace

CycleLevel cycle_level(GroupedRows&& A, EqualRows&& P, GroupedRows&& R, Array<float>&& omega, const Needs& needs_of_A,
                       Workers& workers) {
  CycleLevel level;
  level.rows = static_cast<int>(omega.size());
  level.chunks = wave_chunks(level.rows);
  level.A = std::move(A);
  level.P = std::move(P);
  level.R = std::move(R);
  level.omega = std::move(omega);
  if (level.R.entries().empty()) return level;
  Needs needs_of_R(level.chunks);
  run_throwing(workers, level.chunks, [&](int chunk) { needs_of_R[chunk] = needs_of(level.R, chunk, level.chunks); });
  level.down = Wavefront(level.chunks, {&needs_of_A, &needs_of_R}, workers.count());
  const Needs readers_of_A = both_ways(needs_of_A);
  level.up = Wavefront(level.chunks, {&needs_of_A, &readers_of_A}, workers.count());
  return level;
}

}  // namespace holomorph::solver
