#include "solver/conjugate_gradients.h"

#include <algorithm>
#include <cmath>

#include "base/page_allocator.h"
#include "base/workers.h"
#include "solver/laplace_solver.h"

namespace holomorph::solver {
namespace {

// The residual of the recurrence drifts from the true one. So the true one is computed at the end, and where it is
// still too large, another round of iterations begins. The last round is one that leaves more than this part of it.
constexpr double kLeastGain = 0.5;
// The recurrence goes on to this part of the goal, so that the true residual reaches the goal in the first round.
constexpr double kOfGoal = 0.9;
constexpr double kStep = 8;  // operations for each unknown and right-hand side

template <int K>
using Values = Eigen::Array<double, K, 1>;

template <int K>
class Gradients {
 public:
  Gradients(const Laplacian& L, const GradientOptions& options, Execution& execution)
      : L_(L),
        options_(options),
        execution_(execution),
        workers_(execution.workers()),
        n_(L.size()),
        inverse_(n_, 1.0),
        x_(n_),
        r_(n_),
        p_(n_),
        q_(n_) {
    if (options.scaling == Scaling::none) return;
    for (int i = 0; i < n_; ++i) {
      for (int e = L.starts[i]; e < L.starts[i + 1]; ++e) {
        if (L.columns[e] == i && L.weights[e] > 0) inverse_[i] = 1 / L.weights[e];
      }
    }
  }

  // Columns first .. first + width - 1.
  GradientReport solve(const Eigen::MatrixXd& B, Eigen::MatrixXd& X, Eigen::Index first, int width) {
    const auto column = [&](const Eigen::MatrixXd& M, int i) {
      Values<K> row = Values<K>::Zero();
      for (int d = 0; d < width; ++d) row[d] = M(i, first + d);
      return row;
    };
    Array<Values<K>> b(n_);
    for (int i = 0; i < n_; ++i) {
      b[i] = column(B, i);
      x_[i] = column(X, i);
    }
    const Values<K> norm_b = norm_of(b);
    const Values<K> goal = options_.residual * norm_b;
    GradientReport result;
    Values<K> norm = residual(b), before;
    do {
      before = norm;
      iterate(norm, norm_b, result.iterations);
      norm = residual(b);
      // Another round only if each right-hand side has converged or gained by the last one.
    } while (!(norm <= goal).all() && ((norm <= goal) || (norm < kLeastGain * before)).all());
    result.residual = largest_relative(norm, norm_b);
    result.converged = (norm <= goal).all();
    result.is_rounding = (norm <= kRoundingOfTerms * terms(b)).all();
    for (int i = 0; i < n_; ++i) {
      for (int d = 0; d < width; ++d) X(i, first + d) = x_[i][d];
    }
    return result;
  }

 private:
  static Values<K> zero() { return Values<K>::Zero(); }

  Values<K> product(const Array<Values<K>>& v, int i) const {
    Values<K> sum = Values<K>::Zero();
    for (int e = L_.starts[i]; e < L_.starts[i + 1]; ++e) sum += L_.weights[e] * v[L_.columns[e]];
    return sum;
  }

  Values<K> norm_of(const Array<Values<K>>& b) const {
    return sum_over_rows(workers_, n_, zero(), [&](int i, Values<K>& sum) { sum += b[i].square(); }).sqrt();
  }

  // r = b - L x without its mean; returns the norms.
  Values<K> residual(const Array<Values<K>>& b) {
    Values<K> mean = sum_over_rows(workers_, n_, zero(), [&](int i, Values<K>& sum) {
      r_[i] = b[i] - product(x_, i);
      sum += r_[i];
    });
    // Constants are the kernel of L, and so the mean of the residual cannot be solved for: it is rounding.
    mean /= n_;
    return sum_over_rows(workers_, n_, zero(),
                         [&](int i, Values<K>& sum) {
                           r_[i] -= mean;
                           sum += r_[i].square();
                         })
        .sqrt();
  }

  // The norms of the terms that the residual is the difference of.
  Values<K> terms(const Array<Values<K>>& b) const {
    return sum_over_rows(workers_, n_, zero(),
                         [&](int i, Values<K>& sum) {
                           Values<K> size = b[i].abs();
                           for (int e = L_.starts[i]; e < L_.starts[i + 1]; ++e)
                             size += std::abs(L_.weights[e]) * x_[L_.columns[e]].abs();
                           sum += size.square();
                         })
        .sqrt();
  }

  void iterate(Values<K> norm, const Values<K>& norm_b, int& iterations) {
    using Both = Eigen::Array<double, 2 * K, 1>;
    const Values<K> goal = kOfGoal * (options_.residual * norm_b);
    Values<K> rz = sum_over_rows(workers_, n_, zero(), [&](int i, Values<K>& sum) {
      p_[i] = inverse_[i] * r_[i];
      sum += r_[i] * p_[i];
    });
    for (; !(norm <= goal).all() && iterations < options_.most_iterations; ++iterations) {
      Execution::count(kStep * n_ * K);
      execution_.report(part_of_digits(largest_relative(norm, norm_b), options_.residual));
      const Values<K> pq = sum_over_rows(workers_, n_, zero(), [&](int i, Values<K>& sum) {
        q_[i] = product(p_, i);
        sum += p_[i] * q_[i];
      });
      // A right-hand side that has converged is left alone: its numbers would shrink to denormal ones.
      const Values<K> alpha = (norm <= goal).select(zero(), quotient<K>(rz, pq));
      const Both sums = sum_over_rows(workers_, n_, Both::Zero().eval(), [&](int i, Both& sum) {
        x_[i] += alpha * p_[i];
        r_[i] -= alpha * q_[i];
        const Values<K> square = r_[i].square();
        sum.template head<K>() += square;
        sum.template tail<K>() += inverse_[i] * square;
      });
      norm = sums.template head<K>().sqrt();
      const Values<K> beta = quotient<K>(sums.template tail<K>(), rz);
      rz = sums.template tail<K>();
      for_rows(workers_, n_, [&](int i) { p_[i] = inverse_[i] * r_[i] + beta * p_[i]; });
    }
  }

  const Laplacian& L_;
  const GradientOptions& options_;
  Execution& execution_;
  Workers& workers_;
  const int n_;
  std::vector<double> inverse_;  // inverse of the diagonal, or ones
  Array<Values<K>> x_, r_, p_, q_;
};

}  // namespace

GradientReport conjugate_gradients(const Laplacian& L, const Eigen::MatrixXd& B, Eigen::MatrixXd& X,
                                   const GradientOptions& options, Execution& execution) {
  GradientReport total{0, 0, true, true};
  for_column_blocks(B.cols(), [&](auto width_of_block, Eigen::Index begin, Eigen::Index end) {
    constexpr int K = width_of_block;
    Gradients<K> gradients(L, options, execution);
    for (Eigen::Index first = begin; first < end; first += K) {
      const auto width = static_cast<int>(std::min<Eigen::Index>(K, end - first));
      const GradientReport block = gradients.solve(B, X, first, width);
      total.iterations = std::max(total.iterations, block.iterations);
      total.residual = std::max(total.residual, block.residual);
      total.converged = total.converged && block.converged;
      total.is_rounding = total.is_rounding && block.is_rounding;
    }
  });
  return total;
}

}  // namespace holomorph::solver
