#include "solver/multigrid/block_solve.h"

#include <cmath>
#include <sstream>

#include "solver/laplace_solver.h"

namespace holomorph::solver {

// Two sums: the first and second moments of right-hand sides, or r.z and z.A z.
template <int K>
struct Moments {
  Sums<K> first = Sums<K>::Zero(), second = Sums<K>::Zero();
  Moments& operator+=(const Moments& other) {
    first += other.first;
    second += other.second;
    return *this;
  }
};

namespace {

// The reduction of the residual that each solve in single precision is asked for.
constexpr double kInnerResidual = 1e-4;
// The last of them goes a little below the goal, since the residual of the recurrence drifts from the true one.
constexpr double kSafety = 0.99;
constexpr int kMostInner = 100, kMostIterations = 300;
// If the true residual is this multiple of that of the recurrence, the rounding of B - L X is reached.
constexpr double kMostDrift = 10;
// The solve ends after this number of corrections in a row that leave more than half of the residual.
constexpr int kMostStalls = 2;

// The Jacobi step with which the cycle begins, for the scaled residual r.
template <int K>
EIGEN_STRONG_INLINE Block<K> scaled_step(const RightHandSides<K>& b, int i, const Sums<K>& r) {
  return jacobi_step<K>(b.omega[i], r.template cast<float>(), b.natural.template cast<float>());
}

// The sum in the order of the chunks.
template <class Sum>
Sum sum_of(const std::vector<Sum>& parts) {
  Sum total = parts[0];
  for (std::size_t c = 1; c < parts.size(); ++c) total += parts[c];
  return total;
}

// The sum over the chunks of what part_of(rows) returns.
template <class Sum, class PartOf>
Sum sum_over_chunks(int rows, Workers& workers, const PartOf& part_of) {
  std::vector<Sum> parts(row_chunks(rows));
  for_chunks(rows, workers, [&](int chunk, Rows range) { parts[chunk] = part_of(range); });
  return sum_of(parts);
}

}  // namespace

template <int K>
BlockSolve<K>::BlockSolve(const Laplacian& L, const Hierarchy& hierarchy, double goal, Workers& workers)
    : L_(L),
      A_(hierarchy.levels[0].op),
      n_(L.size()),
      goal_(goal),
      workers_(workers),
      cycle_(hierarchy, workers),
      x_(n_),
      p_(n_),
      q_(n_) {
  for_rows(workers, n_, [p = p_.data(), q = q_.data()](int i) { p[i] = q[i] = Block<K>::Zero(); });
}

template <int K>
RightHandSides<K> BlockSolve<K>::right_hand_sides(const Eigen::MatrixXd& B, const std::vector<Condition>& conditions,
                                                  Eigen::Index first, int width) {
  RightHandSides<K> b;
  for (int d = 0; d < K; ++d) {
    const Eigen::Index column = first + (d < width ? d : 0);  // the first one again, where the block is not full
    b.columns[d] = B.col(column).data();
    b.natural[d] = conditions[column] == Condition::natural ? 1 : 0;
  }
  b.omega = A_.omega.data();
  natural_ = b.natural.template cast<float>();
  cycle_.set_conditions(natural_);
  begin(b);
  return b;
}

template <int K>
void BlockSolve<K>::solve(const Eigen::MatrixXd& B, const std::vector<Condition>& conditions, Eigen::Index first,
                          int width, Solution& X, const Report& report) {
  correct_until_solved(right_hand_sides(B, conditions, first, width), report);
  for_rows(workers_, n_, [&](int i) { X.row(i).segment(first, width) = x_[i].head(width); });
}

template <int K>
void BlockSolve<K>::run_cycle(const Eigen::MatrixXd& B, const std::vector<Condition>& conditions, Eigen::Index first,
                              int width, Solution& X) {
  right_hand_sides(B, conditions, first, width);
  cycle_.run([](int, Rows) {});
  for_rows(workers_, n_, [&, z = cycle_.result()](int i) {
    X.row(i).segment(first, width) = (scale_ * z[i].template cast<double>()).head(width);
  });
}

template <int K>
void BlockSolve<K>::correct_until_solved(const RightHandSides<K>& b, const Report& report) {
  double before = reached_;
  for (int stalls = 0; !(reached_ <= goal_); before = reached_) {
    report(reached_);
    conjugate_gradients(report);
    update_residual(b);
    stalls = reached_ < 0.5 * before ? 0 : stalls + 1;
    const bool too_many = iterations_ >= kMostIterations;
    const bool rounding = reached_ > kMostDrift * largest_relative(scale_, norm_b_);
    // The promise is kept, and no more is to be gained.
    if (reached_ <= kResidual && (stalls > 0 || too_many || rounding)) break;
    if (stalls == kMostStalls || too_many || !std::isfinite(reached_)) {
      std::ostringstream message;
      message << "multigrid reached a relative residual of " << reached_ << " instead of 1e-10 after " << iterations_
              << " iterations, on a system of " << n_ << " unknowns";
      throw SolverError(message.str());
    }
  }
  report(reached_);
}

// The mean of the right-hand sides, their norms, and the residual of X = 0.
template <int K>
void BlockSolve<K>::begin(RightHandSides<K>& b) {
  const Moments<K> moments = sum_over_rows(workers_, n_, Moments<K>(), [b](int i, Moments<K>& sums) {
    const Sums<K> here = b(i);
    sums.first += here;
    sums.second += here.square();
  });
  b.mean = moments.first * b.natural / static_cast<double>(n_);
  // Residuals are divided by this scale, which keeps them in the range of single precision.
  scale_ = moments.second.sqrt();
  const Sums<K> zero = Sums<K>::Zero(), inverse = quotient<K>(Sums<K>::Ones(), scale_);
  norm_b_ = sum_over_rows(workers_, n_, zero, [=, x = x_.data(), s = cycle_.step()](int i, Sums<K>& sum) {
              const Sums<K> here = b(i);
              sum += here.square();
              x[i] = zero;
              s[i] = scaled_step<K>(b, i, here * inverse);
            }).sqrt();
  norm_r_ = norm_b_;
  reached_ = largest_relative(norm_r_, norm_b_);
  iterations_ = 0;
}

// The residual of X, from differences and in double precision.
template <int K>
void BlockSolve<K>::update_residual(const RightHandSides<K>& b) {
  const Sums<K> inverse = quotient<K>(Sums<K>::Ones(), scale_);
  const int *const starts = L_.starts.data(), *const columns = L_.columns.data();
  const double* const weights = L_.weights.data();
  norm_r_ = sum_over_chunks<Sums<K>>(n_, workers_, [=, x = x_.data(), s = cycle_.step()](Rows rows) {
              Sums<K> sum = Sums<K>::Zero();
              for (int i = rows.begin; i < rows.end; ++i) {
                const Sums<K> here = x[i];
                Sums<K> residual = b(i);
                for (int e = starts[i]; e < starts[i + 1]; ++e) residual += weights[e] * (here - x[columns[e]]);
                residual = b.masked(i, residual);
                sum += residual.square();
                s[i] = scaled_step<K>(b, i, residual * inverse);
              }
              return sum;
            }).sqrt();
  reached_ = largest_relative(norm_r_, norm_b_);
}

template <int K>
void BlockSolve<K>::conjugate_gradients(const Report& report) {
  const Sums<K> goal = quotient<K>((kInnerResidual * norm_r_).max(kSafety * goal_ * norm_b_), scale_);
  const int most = std::min(iterations_ + kMostInner, kMostIterations);
  Sums<K> norm, rz = Sums<K>::Zero(), zAz = rz, pAp = rz;
  do {
    const Sums<K> rz_before = rz;
    precondition(rz, zAz);
    const Sums<K> beta = quotient<K>(rz, rz_before);
    // p = z + beta p_before, and p is A-orthogonal to p_before: so p.A p = z.A z - beta^2 p_before.A p_before.
    pAp = zAz - beta.square() * pAp;
    norm = step(quotient<K>(rz, pAp).template cast<float>(), beta.template cast<float>());
    ++iterations_;
    report(largest_relative<Sums<K>>(norm * scale_, norm_b_));
  } while (!(norm <= goal).all() && iterations_ < most);
  // About what the residual will be; it serves the range of single precision only.
  scale_ *= norm;
}

// z from r, then A z, r.z and z.A z.
template <int K>
void BlockSolve<K>::precondition(Sums<K>& rz, Sums<K>& zAz) {
  const Block<K>*const s = cycle_.step(), *const z = cycle_.result();
  Block<K>* const Az = cycle_.scratch();
  const float* const omega = A_.omega.data();
  std::vector<Moments<K>> parts(row_chunks(n_));
  cycle_.run([=, &A = A_.A, &parts](int chunk, Rows rows) {
    Block<K> with_r = Block<K>::Zero(), with_Az = with_r;
    for_differences<K>(A, rows, z, [=, &with_r, &with_Az](int i, const Block<K>& Az_i) {
      Az[i] = Az_i;
      with_r += residual_of_step<K>(omega[i], s[i]) * z[i];
      with_Az += z[i] * Az_i;
    });
    parts[chunk] = {with_r.template cast<double>(), with_Az.template cast<double>()};
  });
  const Moments<K> products = sum_of(parts);
  rz = products.first;
  zAz = products.second;
}

// p = z + beta p, A p alike, x += alpha p, r -= alpha A p. Returns |r|.
template <int K>
Sums<K> BlockSolve<K>::step(const Block<K>& alpha, const Block<K>& beta) {
  const Block<K>*const z = cycle_.result(), *const Az = cycle_.scratch();
  const Block<K> a = alpha, b = beta, natural = natural_;
  const Sums<K> scale = scale_;
  return sum_over_chunks<Sums<K>>(n_, workers_,
                                  [=, s = cycle_.step(), p = p_.data(), q = q_.data(), x = x_.data(),
                                   omega = A_.omega.data()](Rows rows) -> Sums<K> {
                                    Block<K> sum = Block<K>::Zero();
                                    for (int i = rows.begin; i < rows.end; ++i) {
                                      const Block<K> p_i = z[i] + b * p[i], q_i = Az[i] + b * q[i];
                                      const Block<K> change = a * p_i,
                                                     s_i = s[i] - jacobi_step<K>(omega[i], a * q_i, natural);
                                      p[i] = p_i;
                                      q[i] = q_i;
                                      s[i] = s_i;
                                      x[i] += scale * change.template cast<double>();
                                      sum += residual_of_step<K>(omega[i], s_i).square();
                                    }
                                    return sum.template cast<double>();
                                  })
      .sqrt();
}

template class BlockSolve<2>;
template class BlockSolve<4>;
template class BlockSolve<8>;

}  // namespace holomorph::solver
