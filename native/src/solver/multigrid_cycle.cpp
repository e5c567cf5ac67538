#include "solver/multigrid_cycle.h"

#include <initializer_list>

namespace holomorph::solver {
namespace {

template <int K>
Ahead ahead(const CycleLevel& level, int next, std::initializer_list<const Blocks<K>*> arrays) {
  Ahead result;
  if (next == Wavefront::kNone) return result;
  for (const Blocks<K>* const x : arrays) result.add(x->data() + level.begin(next), x->data() + level.end(next));
  return result;
}

}  // namespace

template <int K>
Cycle<K>::Cycle(const Hierarchy& hierarchy, Workers& workers)
    : hierarchy_(hierarchy), workers_(workers), work_(hierarchy.levels.size()) {
  for (std::size_t k = 0; k < work_.size(); ++k) {
    const std::size_t n = hierarchy.levels[k].rows;
    work_[k].s.resize(n);
    work_[k].u.resize(n);
    if (k == 0 || k + 1 < work_.size()) work_[k].t.resize(n);
  }
  const auto rows = [&](std::size_t k) { return hierarchy.levels[k].rows; };
  while (twice_ + 1 < work_.size() && rows(twice_) > rows(0) / kTwice) ++twice_;
  first_.resize(rows(twice_));
}

// What the way down, or up, reads and writes in a chunk, but for the matrices: these it reads in one go.
template <int K>
Ahead Cycle<K>::ahead_up(std::size_t k, int next) const {
  return ahead<K>(hierarchy_.levels[k], next, {&work_[k].s, &work_[k].t, &work_[k].u});
}

template <int K>
void Cycle<K>::descend(std::size_t k) {
  const CycleLevel& level = hierarchy_.levels[k];
  const Work& work = work_[k];
  level.down.run(
      workers_, [](int, int) {},
      [&, k](int chunk, int next) {
        residual_after_start(k, chunk, ahead<K>(level, next, {&work.s, &work.t}));
      },
      [this, k](int chunk, int) { restrict_residual(k, chunk); });
}

template <int K>
void Cycle<K>::ascend(std::size_t k) {
  hierarchy_.levels[k].up.run(
      workers_, [this, k](int chunk, int) { carry_up(k, chunk); },
      [this, k](int chunk, int next) { smooth(k, chunk, ahead_up(k, next)); });
}

// t = r - A s
template <int K>
void Cycle<K>::residual_after_start(std::size_t k, int chunk, const Ahead& ahead) {
  const Block<K>* const s = work_[k].s.data();
  Block<K>* const t = work_[k].t.data();
  const float* const omega = hierarchy_.levels[k].omega.data();
  for_differences<K>(
      hierarchy_.levels[k].A, chunk, s,
      [t, s, omega](int i, const Block<K>& As) { t[i] = residual_of_step<K>(omega[i], s[i]) - As; }, ahead);
}

// s = omega R t of the level above
template <int K>
void Cycle<K>::restrict_residual(std::size_t k, int chunk) {
  Block<K>* const s = work_[k + 1].s.data();
  const float* const omega = hierarchy_.levels[k + 1].omega.data();
  const Block<K> natural = natural_;
  for_products<K>(hierarchy_.levels[k].R, chunk, work_[k].t.data(),
                  [=](int i, const Block<K>& Rt) { s[i] = jacobi_step<K>(omega[i], Rt, natural); });
}

// From the start of level k down to the coarsest level and back.
template <int K>
template <class Last>
void Cycle<K>::correct(std::size_t k, const Last& last) {
  const std::size_t coarsest = work_.size() - 1;
  for (std::size_t j = k; j < coarsest; ++j) descend(j);
  solve_coarsest();
  for (std::size_t j = coarsest; --j > k;) ascend(j);
  ascend(k, last);
}

// 2 M - M A M for the M of one correction.
template <int K>
void Cycle<K>::correct_twice() {
  if (twice_ + 1 == work_.size()) return solve_coarsest();
  const CycleLevel& level = hierarchy_.levels[twice_];
  Block<K>*const s = work_[twice_].s.data(), *const u = work_[twice_].u.data(), *const once = first_.data();
  const float* const omega = level.omega.data();
  const Block<K> natural = natural_;
  correct(twice_, [=, &level](int chunk, const Ahead&) {
    for_differences<K>(level.A, chunk, u, [=](int i, const Block<K>& Au) {
      once[i] = u[i];
      s[i] -= jacobi_step<K>(omega[i], Au, natural);
    });
  });
  correct(twice_, [=, &level](int chunk, const Ahead&) {
    for (int i = level.begin(chunk), end = level.end(chunk); i < end; ++i) u[i] += once[i];
  });
}

template <int K>
void Cycle<K>::solve_coarsest() {
  const Array<float>& omega = hierarchy_.levels.back().omega;
  Work& work = work_.back();
  const auto add = [&](const Eigen::MatrixXf& inverse, const Block<K>& conditions) {
    for (Eigen::Index j = 0; j < inverse.cols(); ++j) {
      const Block<K> r = conditions * residual_of_step<K>(omega[j], work.s[j]);
      for (Eigen::Index i = 0; i < inverse.rows(); ++i) work.u[i] += inverse(i, j) * r;
    }
  };
  std::fill(work.u.begin(), work.u.end(), Block<K>::Zero());
  add(hierarchy_.coarsest_inverse, natural_);
  if (!(natural_ == 1).all()) add(hierarchy_.held_inverse, 1 - natural_);
}

// t = s + P u_coarse
template <int K>
void Cycle<K>::carry_up(std::size_t k, int chunk) {
  const CycleLevel& level = hierarchy_.levels[k];
  const Block<K>*const s = work_[k].s.data(), *const coarse = work_[k + 1].u.data();
  Block<K>* const t = work_[k].t.data();
  for_products<K>(level.P, level.begin(chunk), level.end(chunk), coarse,
                  [=](int i, const Block<K>& Pu) { t[i] = s[i] + Pu; });
}

// u = t + omega (r - A t)
template <int K>
void Cycle<K>::smooth(std::size_t k, int chunk, const Ahead& ahead) {
  const Block<K>*const s = work_[k].s.data(), *const t = work_[k].t.data();
  Block<K>* const u = work_[k].u.data();
  const float* const omega = hierarchy_.levels[k].omega.data();
  const Block<K> natural = natural_;
  for_differences<K>(
      hierarchy_.levels[k].A, chunk, t,
      [=](int i, const Block<K>& At) { u[i] = t[i] + (s[i] - jacobi_step<K>(omega[i], At, natural)); }, ahead);
}

template class Cycle<2>;
template class Cycle<4>;
template class Cycle<8>;

}  // namespace holomorph::solver
