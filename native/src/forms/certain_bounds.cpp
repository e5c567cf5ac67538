#include "forms/certain_bounds.h"

#include <cmath>
#include <limits>
#include <string>

#include "base/constants.h"
#include "base/double_double.h"
#include "base/errors.h"
#include "linear/dense.h"

namespace holomorph::forms {

using Eigen::MatrixXd;

namespace {

using Eigen::Index;
using Eigen::VectorXd;

// Covers the rounding of a bound of rounding itself: three products of an n x n matrix with a vector whose terms are
// all positive, and some factors.
double slack(Index n) { return 1 + kUnit * static_cast<double>(3 * n + 16); }

// Weights that suit the diagonal of P.
VectorXd weights(const MatrixXd& P) {
  return P.diagonal().cwiseAbs().cwiseSqrt().cwiseMax(std::numeric_limits<double>::min());
}

// Returns the diagonal of a matrix that is not below any symmetric one whose entries are at most those of a symmetric
// matrix E: 2 |x_i x_j| <= (w_j / w_i) x_i^2 + (w_i / w_j) x_j^2. @param products E (1 / w)
VectorXd diagonal_above(const VectorXd& products, const VectorXd& w) {
  return slack(w.size()) * w.cwiseProduct(products);
}

}  // namespace

MatrixXd inverse(const MatrixXd& A) { return linear::Cholesky(A).inverse(); }
MatrixXd symmetric(const MatrixXd& A) { return (A + A.transpose()) / 2; }

MatrixXd geometric_mean(const MatrixXd& A, const MatrixXd& B) {
  const linear::Cholesky root(A);
  if (!root.succeeded())
    throw SolverError("the Gram matrix of " + std::to_string(A.rows()) + " forms is not positive definite");
  // A # B = L (L^-1 B L^-T)^(1/2) L^T for any L with A = L L^T: the mean is invariant under congruence.
  const MatrixXd L = root.lower(), inner = root.solve_lower(root.solve_lower(B).transpose());  // L^-1 B L^-T
  const auto middle = linear::square_root(symmetric(inner));
  if (!middle) {
    throw SolverError("the Gram matrix of " + std::to_string(A.rows()) +
                      " forms is too badly conditioned to be projected");
  }
  return symmetric(linear::congruent(L, *middle));
}

ProjectedStar projected_star(const MatrixXd& G_N, const MatrixXd& G_D, const MatrixXd& W) {
  ProjectedStar result;
  result.lower = symmetric(linear::congruent(W, inverse(G_D)));
  result.natural_gram = geometric_mean(G_N, result.lower);
  result.dirichlet_gram = symmetric(linear::congruent(W.transpose(), inverse(result.natural_gram)));
  // C W^T = G, and G is symmetric: C^T = W^-1 G.
  result.star = linear::solve(W, result.natural_gram).transpose();
  return result;
}

Eigen::MatrixXcd period_matrix(const MatrixXd& G) {
  const auto g = G.rows() / 2;
  // Both are symmetric for a projected Gram matrix, up to the rounding that is removed here.
  const MatrixXd imaginary = symmetric(inverse(G.bottomRightCorner(g, g)));
  const MatrixXd real = symmetric(-linear::product(G.topRightCorner(g, g), imaginary));
  return real.cast<std::complex<double>>() + std::complex<double>(0, 1) * imaginary.cast<std::complex<double>>();
}

// The sums may be taken in any order: each product with n summands is wrong by at most n epsilon |.| |.|, whatever the
// tree of its additions (Higham 2002, section 3.1). The bound of all, |T| |G| |T|^T, is needed times a vector alone.
MatrixXd above_congruent(const MatrixXd& T, const MatrixXd& G) {
  MatrixXd P = symmetric(linear::congruent(T, G));
  const double factor = kUnit * static_cast<double>(2 * G.rows() + 2);  // both products, the mean, the last sum
  const VectorXd w = weights(P);
  const VectorXd errors = T.cwiseAbs() * (G.cwiseAbs() * (T.cwiseAbs().transpose() * w.cwiseInverse()));
  P.diagonal() += diagonal_above(slack(G.rows()) * factor * errors, w);
  return P;
}

MatrixXd below_inverse(const MatrixXd& A) {
  const MatrixXd X = symmetric(inverse(A));
  // 2 X - X A X <= A^-1 (certain_bounds.h). X A X is rounded upwards, so the difference is rounded downwards.
  MatrixXd lower = 2 * X - above_congruent(X, A);
  const VectorXd w = weights(X);
  lower.diagonal() -= diagonal_above(2 * kUnit * (lower.cwiseAbs() * w.cwiseInverse()), w);
  return lower;
}

namespace {

// Re Omega + Z = -[1, -Z] (M + D) [0; Y], Y = Im Omega and G_exact = M + D with -R <= D <= R, R half the width: by
// Cauchy and Schwarz |x D y|^2 <= x R x . y R y, and R_bb <= tr(Y R_bb) G_bb, so y R y <= tr(Y R_bb) Y_jj.
void set_real_bounds(const MatrixXd& G, const MatrixXd& Z, PeriodBounds& bounds) {
  const Index g = Z.rows();
  MatrixXd J = MatrixXd::Zero(2 * g, 2 * g);
  J.topRightCorner(g, g).setIdentity();
  J.bottomLeftCorner(g, g) = -MatrixXd::Identity(g, g);
  const MatrixXd below = linear::congruent(J.transpose(), below_inverse(G));  // only moves and negates entries
  MatrixXd R = (G - below) / 2;
  const VectorXd w = weights(G), inverse_w = w.cwiseInverse();
  R.diagonal() += diagonal_above(2 * kUnit * (G.cwiseAbs() * inverse_w + below.cwiseAbs() * inverse_w), w);
  const MatrixXd M = (G + below) / 2;
  MatrixXd T(g, 2 * g);
  T << MatrixXd::Identity(g, g), -Z;
  // x R x for each row x of T = [1, -Z]; then tr(Y R_bb), its rounding added.
  const VectorXd across = above_congruent(T, R).diagonal().cwiseMax(0);
  const auto R_bb = R.bottomRightCorner(g, g);
  const MatrixXd products = bounds.upper.cwiseProduct(R_bb.transpose());
  const double trace = std::max(0.0, products.colwise().sum().sum()) +
                       kUnit * static_cast<double>(2 * g + 1) * products.cwiseAbs().colwise().sum().sum();
  // The part of the midpoint M: |rest Y|_ij <= sum_k |rest_ik| sqrt(Y_kk Y_jj), since Y is positive definite.
  const MatrixXd rest = linear::product(T, M.rightCols(g));
  const double factor = kUnit * static_cast<double>(2 * g + 2);
  const VectorXd root = bounds.upper.diagonal().cwiseSqrt();
  const VectorXd missed =
      rest.cwiseAbs() * root + slack(2 * g) * factor * (T.cwiseAbs() * (M.rightCols(g).cwiseAbs() * root));
  bounds.real_lower.resize(g, g);
  bounds.real_upper.resize(g, g);
  for (Index i = 0; i < g; ++i) {
    for (Index j = 0; j < g; ++j) {
      const double radius =
          slack(2 * g) * (std::sqrt(across[i] * trace) * root[j] + missed[i] * root[j]) + 2 * kUnit * std::abs(Z(i, j));
      bounds.real_lower(i, j) = -Z(i, j) - radius;
      bounds.real_upper(i, j) = -Z(i, j) + radius;
    }
  }
  // Omega is symmetric: the narrower of both intervals holds for both entries.
  bounds.real_lower = bounds.real_lower.cwiseMax(bounds.real_lower.transpose()).eval();
  bounds.real_upper = bounds.real_upper.cwiseMin(bounds.real_upper.transpose()).eval();
}

}  // namespace

PeriodBounds period_bounds(const MatrixXd& G, Execution& execution) {
  const Index g = G.rows() / 2;
  PeriodBounds bounds;
  bounds.lower = below_inverse(G.bottomRightCorner(g, g));
  // Any Z gives an upper bound; this one is the best, up to rounding.
  const MatrixXd Z = linear::product(G.topRightCorner(g, g), bounds.lower);
  MatrixXd T(g, 2 * g);
  T << MatrixXd::Identity(g, g), -Z;
  bounds.upper = above_congruent(T, G);
  execution.report(0.7);
  set_real_bounds(G, Z, bounds);
  return bounds;
}

}  // namespace holomorph::forms
