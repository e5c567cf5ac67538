#include "solver/block_solve.h"

#include <cmath>
#include <sstream>

namespace holomorph::solver {
namespace {

// What single precision is asked for at a time: less takes more corrections, more gains nothing.
// Its products are summed in single precision, too, chunk by chunk.
constexpr double kInnerResidual = 1e-4;
// The last time it goes a little below the goal, as the residual that it carries along drifts from the true one: by a
// thousandth of it at most, after the first correction, which has to find what is smooth and large.
constexpr double kSafety = 0.99;
constexpr int kMostInner = 100, kMostIterations = 300;
// Where so many times the residual that was carried along is left, it is the rounding of B - L X.
constexpr double kMostDrift = 10;
// Corrections in a row that leave more than half of the residual.
constexpr int kMostStalls = 2;

// a / b where b > 0, else 0: a right-hand side that is solved exactly stays as it is.
template <int K>
Sums<K> quotient(const Sums<K>& a, const Sums<K>& b) {
  Sums<K> result;
  for (int d = 0; d < K; ++d) result[d] = b[d] > 0 ? a[d] / b[d] : 0.0;
  return result;
}

// The Jacobi step with which conjugate gradients begin, of the scaled residual r.
template <int K>
EIGEN_STRONG_INLINE Block<K> scaled_step(const RightHandSides<K>& b, int i, const Sums<K>& r) {
  return jacobi_step<K>(b.omega[i], r.template cast<float>(), b.natural.template cast<float>());
}

}  // namespace

template <int K>
BlockSolve<K>::BlockSolve(const Hierarchy& hierarchy, double goal, Workers& workers)
    : level_(hierarchy.levels[0]),
      rests_(hierarchy.rests),
      n_(level_.rows),
      goal_(goal),
      workers_(workers),
      cycle_(hierarchy, workers),
      p_(n_),
      q_(n_) {}

template <int K>
void BlockSolve<K>::solve(const Eigen::MatrixXd& B, const std::vector<Condition>& conditions, Eigen::Index first,
                          int width, Solution& X, const Report& report) {
  if (X.cols() == K) {
    x_ = X.data();
  } else {
    own_.resize(static_cast<std::size_t>(K) * n_);
    x_ = own_.data();
  }
  RightHandSides<K> b;
  for (int d = 0; d < K; ++d) {
    const Eigen::Index column = first + (d < width ? d : 0);  // the first one again, where the block is not full
    b.columns[d] = B.col(column).data();
    b.natural[d] = conditions[column] == Condition::natural ? 1 : 0;
  }
  b.omega = level_.omega.data();
  natural_ = b.natural.template cast<float>();
  cycle_.set_conditions(natural_);
  begin(b);
  double before = reached_;
  for (int stalls = 0; !(reached_ <= goal_); before = reached_) {
    report(reached_);
    conjugate_gradients(report);
    update_residual(b);
    stalls = reached_ < 0.5 * before ? 0 : stalls + 1;
    const bool tired = iterations_ >= kMostIterations;
    const bool rounding = reached_ > kMostDrift * relative(scale_);
    if (reached_ <= kResidual && (stalls > 0 || tired || rounding)) break;
    if (stalls == kMostStalls || tired || !std::isfinite(reached_)) {
      std::ostringstream message;
      message << "multigrid reached a relative residual of " << reached_ << " instead of 1e-10 after " << iterations_
              << " iterations, on a system of " << n_ << " unknowns";
      throw SolverError(message.str());
    }
  }
  report(reached_);
  if (x_ == X.data()) return;
  for_rows(workers_, n_, [&](int i) { X.row(i).segment(first, width) = row_of(x_, i).head(width); });
}

// The mean of the right-hand sides, their norms, and the residual of X = 0.
template <int K>
void BlockSolve<K>::begin(RightHandSides<K>& b) {
  struct Moments {
    Sums<K> first = Sums<K>::Zero(), second = Sums<K>::Zero();
    Moments& operator+=(const Moments& other) {
      first += other.first;
      second += other.second;
      return *this;
    }
  };
  const Moments moments = sum_over_rows(workers_, n_, Moments(), [b](int i, Moments& sums) {
    const Sums<K> here = b(i);
    sums.first += here;
    sums.second += here.square();
  });
  b.mean = moments.first * b.natural / static_cast<double>(n_);
  scale_ = moments.second.sqrt();
  const Sums<K> zero = Sums<K>::Zero(), inverse = quotient<K>(Sums<K>::Ones(), scale_);
  norm_b_ = sum_over_rows(workers_, n_, zero, [=, x = x_, s = cycle_.start()](int i, Sums<K>& sum) {
              const Sums<K> here = b(i);
              sum += here.square();
              row_of(x, i) = zero;
              s[i] = scaled_step<K>(b, i, here * inverse);
            }).sqrt();
  norm_r_ = norm_b_;
  reached_ = relative(norm_r_);
  iterations_ = 0;
}

// The residual of X, from differences and with the weights in double precision.
template <int K>
void BlockSolve<K>::update_residual(const RightHandSides<K>& b) {
  const Sums<K> zero = Sums<K>::Zero(), inverse = quotient<K>(Sums<K>::Ones(), scale_);
  const Entry* const first = level_.A.entries().data();
  std::vector<Sums<K>> parts(level_.chunks, zero);
  workers_.run(level_.chunks, [&](int, int chunk) {
    Sums<K> sum = zero;
    level_.A.for_rows(chunk, [=, this, &sum, x = x_, s = cycle_.start()](int i, const Entry* entries, int length) {
      const float* const rests = rests_.data() + (entries - first);
      prefetch(rests + GroupedRows::kAhead);
      const Sums<K> here = row_of(x, i);
      Sums<K> residual = b(i);
      for (int e = 0; e < length; ++e) {
        const double weight = static_cast<double>(entries[e].weight) + static_cast<double>(rests[e]);
        residual -= weight * (here - row_of(x, entries[e].column));
      }
      residual = b.asked(i, residual);
      sum += residual.square();
      s[i] = scaled_step<K>(b, i, residual * inverse);
    });
    parts[chunk] = sum;
  });
  norm_r_ = zero;
  for (const Sums<K>& part : parts) norm_r_ += part;
  norm_r_ = norm_r_.sqrt();
  reached_ = relative(norm_r_);
}

template <int K>
void BlockSolve<K>::conjugate_gradients(const Report& report) {
  const Sums<K> goal = quotient<K>((kInnerResidual * norm_r_).max(kSafety * goal_ * norm_b_), scale_);
  Sums<K> norm = quotient<K>(norm_r_, scale_);
  Sums<K> rz = Sums<K>::Zero(), zAz = rz, pAp = rz;
  Block<K> a_before = Block<K>::Zero();
  Sums<K> reduction = Sums<K>::Ones();  // of the residual, by the step before
  const int before = iterations_;
  cycle_.down();
  for (bool ended = false; !ended;) {
    const Sums<K> rz_before = rz;
    precondition(rz, zAz);
    const Sums<K> beta = quotient<K>(rz, rz_before);
    pAp = zAz - beta.square() * pAp;
    const Block<K> a = quotient<K>(rz, pAp).template cast<float>(), b = beta.template cast<float>();
    // Steps along p are added to X two at a time, as with each p the one before is still known.
    const int done = iterations_ - before;
    const bool foreseen = (norm * reduction <= goal).all();
    const Sums<K> norm_before = norm;
    norm = done == 0       ? step<true, false>(a_before, a, b, foreseen)
           : done % 2 == 0 ? step<false, false>(a_before, a, b, foreseen)
                           : step<false, true>(a_before, a, b, foreseen);
    reduction = quotient<K>(norm, norm_before);
    a_before = a;
    ++iterations_;
    report(relative(norm * scale_));
    ended = (norm <= goal).all() || iterations_ == before + kMostInner || iterations_ == kMostIterations;
    if (foreseen && !ended) cycle_.down();
  }
  const bool odd = (iterations_ - before) % 2 != 0;
  if (odd) for_rows(workers_, n_, [&](int i) { row_of(x_, i) += scale_ * (a_before * p_[i]).template cast<double>(); });
  // About what the residual will be; it serves the range of single precision only.
  scale_ *= norm;
}

// From r, on the coarse levels: z, A z, r.z and z.A z.
template <int K>
void BlockSolve<K>::precondition(Sums<K>& rz, Sums<K>& zAz) {
  struct Products {
    Sums<K> rz, zAz;
  };
  std::vector<Products> parts(level_.chunks);
  const Block<K>*const s = cycle_.start(), *const z = cycle_.result();
  Block<K>* const w = cycle_.from_z();
  const float* const omega = level_.omega.data();
  cycle_.up([&](int chunk, const Ahead& ahead) {
    Block<K> with_r = Block<K>::Zero(), with_Az = with_r;
    const auto add = [s, z, w, omega, &with_r, &with_Az](int i, const Block<K>& Az) {
      w[i] = Az;
      with_r += residual_of_step<K>(omega[i], s[i]) * z[i];
      with_Az += z[i] * Az;
    };
    for_differences<K>(level_.A, chunk, z, add, ahead);
    parts[chunk] = {with_r.template cast<double>(), with_Az.template cast<double>()};
  });
  rz = zAz = Sums<K>::Zero();
  for (const Products& products : parts) {
    rz += products.rz;
    zAz += products.zAz;
  }
}

// The step of conjugate gradients, and the way down from the new r, unless it is to be the last one. Returns |r|. The
// first step writes p and q; one that adds takes the step before it and its own to X.
template <int K>
template <bool first, bool adds>
Sums<K> BlockSolve<K>::step(const Block<K>& alpha_before, const Block<K>& alpha, const Block<K>& beta, bool last) {
  std::vector<Sums<K>> parts(level_.chunks);
  Block<K>*const s = cycle_.start(), *const p = p_.data(), *const q = q_.data();
  double* const x = x_;
  const Block<K>*const z = cycle_.result(), *const w = cycle_.from_z();
  const float* const omega = level_.omega.data();
  const Block<K> a_before = alpha_before, a = alpha, b = beta, natural = natural_;
  const Sums<K> scale = scale_;
  const auto loop = [=, this, &parts](int chunk) {
    Block<K> sum = Block<K>::Zero();
    for (int i = level_.begin(chunk), end = level_.end(chunk); i < end; ++i) {
      Block<K> p_i = z[i], q_i = w[i];
      if constexpr (!first) {
        p_i += b * p[i];
        q_i += b * q[i];
      }
      if constexpr (adds) {
        const Block<K> both = a_before * p[i] + a * p_i;
        row_of(x, i) += scale * both.template cast<double>();
      }
      p[i] = p_i;
      q[i] = q_i;
      const Block<K> step = a * q_i, s_i = s[i] - jacobi_step<K>(omega[i], step, natural);
      s[i] = s_i;
      sum += residual_of_step<K>(omega[i], s_i).square();
    }
    parts[chunk] = sum.template cast<double>();
  };
  if (last) {
    cycle_.for_chunks(loop);
  } else {
    cycle_.down(loop);
  }
  Sums<K> sum = Sums<K>::Zero();
  for (const Sums<K>& part : parts) sum += part;
  return sum.sqrt();
}

template <int K>
double BlockSolve<K>::relative(const Sums<K>& norms) const {
  double worst = 0;
  for (int d = 0; d < K; ++d) {
    const double ratio = norm_b_[d] > 0 ? norms[d] / norm_b_[d] : norms[d];
    if (!(ratio <= worst)) worst = ratio;  // std::max would drop a NaN
  }
  return worst;
}

template class BlockSolve<2>;
template class BlockSolve<4>;
template class BlockSolve<8>;

}  // namespace holomorph::solver
