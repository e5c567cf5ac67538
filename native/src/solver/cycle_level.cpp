#include "solver/cycle_level.h"

namespace holomorph::solver {

CycleLevel cycle_level(const SparseRows& A, const SparseRows& P, const SparseRows& R, Array<float>&& omega,
                       Workers& workers) {
  CycleLevel level;
  level.rows = A.size();
  level.chunks = (A.size() + kWaveRows - 1) / kWaveRows;
  level.omega = std::move(omega);
  const Chunks rows{A.size(), kWaveRows};
  level.A = GroupedRows(A, rows, level.chunks, workers);
  if (R.size() == 0) return level;
  // A vertex that stays keeps its place among the others, so that equal parts of both levels lie over each other.
  const Chunks coarse{R.size(), (R.size() + level.chunks - 1) / level.chunks};
  level.P = GroupedRows(P, rows, level.chunks, workers);
  level.R = GroupedRows(R, coarse, level.chunks, workers);
  const Needs of_A = needs_of(A, rows, rows, level.chunks, workers);
  const Needs of_R = needs_of(R, coarse, rows, level.chunks, workers);
  level.down = Wavefront(level.chunks, {&of_A, &of_R}, workers.count());
  level.up = Wavefront(level.chunks, {&of_A, &of_A}, workers.count());
  return level;
}

}  // namespace holomorph::solver
