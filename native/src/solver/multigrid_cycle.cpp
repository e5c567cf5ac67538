#include "solver/multigrid_cycle.h"

namespace holomorph::solver {

template <int K>
Cycle<K>::Cycle(const Hierarchy& hierarchy, Workers& workers)
    : hierarchy_(hierarchy), workers_(workers), work_(hierarchy.levels.size()) {
  for (std::size_t k = 0; k < work_.size(); ++k) {
    const std::size_t n = hierarchy.levels[k].rows;
    work_[k].r.resize(n);
    work_[k].u.resize(n);
    if (k == 0 || k + 1 < work_.size()) work_[k].t.resize(n);
  }
  const auto rows = [&](std::size_t k) { return hierarchy.levels[k].rows; };
  while (twice_ + 1 < work_.size() && rows(twice_) > rows(0) / kTwice) ++twice_;
  first_.resize(rows(twice_));
}

// t = r - A u
template <int K>
void Cycle<K>::residual_after_start(std::size_t k, int chunk) {
  const Block<K>* const r = work_[k].r.data();
  Block<K>* const t = work_[k].t.data();
  for_differences<K>(hierarchy_.levels[k].A, chunk, work_[k].u.data(),
                     [t, r](int i, const Block<K>& Au) { t[i] = r[i] - Au; });
}

// r = R t of the level above, and the first step of this one.
template <int K>
void Cycle<K>::restrict_residual(std::size_t k, int chunk) {
  Block<K>*const r = work_[k + 1].r.data(), *const u = work_[k + 1].u.data();
  const float* const omega = hierarchy_.levels[k + 1].omega.data();
  const Block<K> natural = natural_;
  for_products<K>(hierarchy_.levels[k].R, chunk, work_[k].t.data(), [=](int i, const Block<K>& Rt) {
    r[i] = Rt;
    u[i] = jacobi_step<K>(omega[i], Rt, natural);
  });
}

// 2 M - M A M for the M of one correction.
template <int K>
void Cycle<K>::correct_twice() {
  if (twice_ + 1 == work_.size()) return solve_coarsest();
  const CycleLevel& level = hierarchy_.levels[twice_];
  Block<K>*const r = work_[twice_].r.data(), *const u = work_[twice_].u.data(), *const once = first_.data();
  const Block<K> natural = natural_;
  correct(
      twice_, [](int) {},
      [=, &level](int chunk) {
        for_differences<K>(level.A, chunk, u, [r](int i, const Block<K>& Au) { r[i] -= Au; });
      });
  correct(
      twice_,
      [=, &level](int chunk) {
        for (int i = level.begin(chunk), end = level.end(chunk); i < end; ++i) {
          once[i] = u[i];
          u[i] = jacobi_step<K>(level.omega[i], r[i], natural);
        }
      },
      [=, &level](int chunk) {
        for (int i = level.begin(chunk), end = level.end(chunk); i < end; ++i) u[i] += once[i];
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
void Cycle<K>::carry_up(std::size_t k, int chunk) {
  const CycleLevel& level = hierarchy_.levels[k];
  const Block<K>*const u = work_[k].u.data(), *const coarse = work_[k + 1].u.data();
  Block<K>* const t = work_[k].t.data();
  for_products<K>(level.P, level.begin(chunk), level.end(chunk), coarse,
                  [=](int i, const Block<K>& Pu) { t[i] = u[i] + Pu; });
}

// u = t + omega (r - A t)
template <int K>
void Cycle<K>::smooth(std::size_t k, int chunk) {
  const Block<K>*const r = work_[k].r.data(), *const t = work_[k].t.data();
  Block<K>* const u = work_[k].u.data();
  const float* const omega = hierarchy_.levels[k].omega.data();
  const Block<K> natural = natural_;
  for_differences<K>(hierarchy_.levels[k].A, chunk, t,
                     [=](int i, const Block<K>& At) { u[i] = t[i] + jacobi_step<K>(omega[i], r[i] - At, natural); });
}

template class Cycle<2>;
template class Cycle<4>;
template class Cycle<8>;

}  // namespace holomorph::solver
