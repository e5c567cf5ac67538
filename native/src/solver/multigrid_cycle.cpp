#include "solver/multigrid_cycle.h"

namespace holomorph::solver {
namespace {

// (M x)_i, for the rows of P and R.
template <int K>
EIGEN_STRONG_INLINE Block<K> product(const SparseRows& M, int i, const Blocks<K>& x) {
  const int* const column = M.column.data();
  const float* const weight = M.weight.data();
  const Block<K>* const values = x.data();
  Block<K> sum = Block<K>::Zero();
  for (int e = M.start[i], end = M.start[i + 1]; e < end; ++e) sum += weight[e] * values[column[e]];
  return sum;
}

}  // namespace

template <int K>
Cycle<K>::Cycle(const Hierarchy& hierarchy, Workers& workers)
    : hierarchy_(hierarchy), workers_(workers), work_(hierarchy.levels.size()) {
  for (std::size_t k = 0; k < work_.size(); ++k) {
    const std::size_t n = hierarchy.levels[k].A.size();
    work_[k].r.resize(n);
    work_[k].u.resize(n);
    if (k + 1 < work_.size()) work_[k].t.resize(n);
  }
}

template <int K>
Sums<K> Cycle<K>::run() {
  const std::size_t coarsest = work_.size() - 1;
  for (std::size_t k = 0; k < coarsest; ++k) descend(k);
  solve_coarsest();
  for (std::size_t k = coarsest; k-- > 1;) {
    carry_up(k);
    const Level& level = hierarchy_.levels[k];
    auto& [r, u, t] = work_[k];
    for_rows(workers_, level.A.size(), [&, &r = r, &u = u, &t = t](int i) {
      u[i] = t[i] + jacobi_step<K>(level, i, r[i] - difference(level.A, i, t), natural_);
    });
  }
  // On the finest level the sum comes with the last step.
  const Level& level = hierarchy_.levels[0];
  auto& [r, u, t] = work_[0];
  if (coarsest > 0) carry_up(0);
  return sum_over_rows(workers_, level.A.size(), Sums<K>(Sums<K>::Zero()),
                       [&, &r = r, &u = u, &t = t](int i, Sums<K>& sum) {
                         if (coarsest > 0)
                           u[i] = t[i] + jacobi_step<K>(level, i, r[i] - difference(level.A, i, t), natural_);
                         sum += (r[i] * u[i]).template cast<double>();
                       });
}

// The residual after the first step, restricted, and the first step of the next level.
template <int K>
void Cycle<K>::descend(std::size_t k) {
  const Level &level = hierarchy_.levels[k], &next = hierarchy_.levels[k + 1];
  Work &fine = work_[k], &coarse = work_[k + 1];
  for_rows(workers_, level.A.size(), [&](int i) { fine.t[i] = fine.r[i] - difference(level.A, i, fine.u); });
  for_rows(workers_, next.A.size(), [&](int i) {
    const Block<K> r = product(level.R, i, fine.t);
    coarse.r[i] = r;
    coarse.u[i] = jacobi_step<K>(next, i, r, natural_);
  });
}

template <int K>
void Cycle<K>::solve_coarsest() {
  const Eigen::MatrixXf &natural = hierarchy_.coarsest_inverse, &held = hierarchy_.held_inverse;
  const bool some = !(natural_ == 1).all();
  Work& work = work_.back();
  for (Eigen::Index i = 0; i < natural.cols(); ++i) {
    Block<K> sum = Block<K>::Zero(), held_sum = Block<K>::Zero();
    for (Eigen::Index j = 0; j < natural.rows(); ++j) sum += natural(j, i) * work.r[j];  // symmetric
    for (Eigen::Index j = 0; some && j < held.rows(); ++j) held_sum += held(j, i) * work.r[j];
    work.u[i] = some ? Block<K>((natural_ == 1).select(sum, held_sum)) : sum;
  }
}

// t = u + P u_coarse
template <int K>
void Cycle<K>::carry_up(std::size_t k) {
  const Level& level = hierarchy_.levels[k];
  Work& fine = work_[k];
  const Blocks<K>& coarse = work_[k + 1].u;
  for_rows(workers_, level.A.size(), [&](int i) { fine.t[i] = fine.u[i] + product(level.P, i, coarse); });
}

template class Cycle<2>;
template class Cycle<4>;
template class Cycle<8>;

}  // namespace holomorph::solver
