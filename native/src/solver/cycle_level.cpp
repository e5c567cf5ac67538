#include "solver/cycle_level.h"

namespace holomorph::solver {

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
  level.up = Wavefront(level.chunks, {&needs_of_A, &needs_of_A}, workers.count());
  return level;
}

}  // namespace holomorph::solver
