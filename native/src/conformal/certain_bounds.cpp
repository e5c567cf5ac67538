#include "conformal/certain_bounds.h"

#include <cmath>
#include <limits>
#include <string>

#include "base/errors.h"
#include "linear/dense.h"

namespace holomorph::conformal {

using Eigen::MatrixXd;

namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kUnit = std::numeric_limits<double>::epsilon() / 2;

// Covers the rounding of a bound of rounding itself: two products of n x n matrices whose terms are all positive, and
// some factors.
double slack(Index n) { return 1 + kUnit * static_cast<double>(2 * n + 16); }

// Returns a diagonal matrix that is not below any symmetric matrix whose entries are at most those of `errors`: 2 |x_i
// x_j| <= (w_j / w_i) x_i^2 + (w_i / w_j) x_j^2, with weights that suit the diagonal of P.
VectorXd diagonal_above(const MatrixXd& errors, const MatrixXd& P) {
  const VectorXd root = P.diagonal().cwiseAbs().cwiseSqrt().cwiseMax(std::numeric_limits<double>::min());
  return slack(P.rows()) * root.cwiseProduct(errors * root.cwiseInverse());
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
  return symmetric(L * *middle * L.transpose());
}

ProjectedStar projected_star(const MatrixXd& G_N, const MatrixXd& G_D, const MatrixXd& W) {
  ProjectedStar result;
  result.lower = symmetric(W * inverse(G_D) * W.transpose());
  result.natural_gram = geometric_mean(G_N, result.lower);
  result.dirichlet_gram = symmetric(W.transpose() * inverse(result.natural_gram) * W);
  // C W^T = G, and G is symmetric: C^T = W^-1 G.
  result.star = linear::solve(W, result.natural_gram).transpose();
  return result;
}

Eigen::MatrixXcd period_matrix(const MatrixXd& G) {
  const auto g = G.rows() / 2;
  // Both are symmetric for a projected Gram matrix, up to the rounding that is removed here.
  const MatrixXd imaginary = symmetric(inverse(G.bottomRightCorner(g, g)));
  const MatrixXd real = symmetric(-G.topRightCorner(g, g) * imaginary);
  return real.cast<std::complex<double>>() + std::complex<double>(0, 1) * imaginary.cast<std::complex<double>>();
}

MatrixXd above_congruent(const MatrixXd& T, const MatrixXd& G) {
  MatrixXd P = symmetric(T * G * T.transpose());
  const double factor = kUnit * static_cast<double>(2 * G.rows() + 2);  // both products, the mean, the last sum
  const MatrixXd errors = slack(G.rows()) * factor * (T.cwiseAbs() * G.cwiseAbs() * T.cwiseAbs().transpose());
  P.diagonal() += diagonal_above(symmetric(errors), P);
  return P;
}

MatrixXd below_inverse(const MatrixXd& A) {
  const MatrixXd X = symmetric(inverse(A));
  // 2 X - X A X <= A^-1 (certain_bounds.h). X A X is rounded upwards, so the difference is rounded downwards.
  MatrixXd lower = 2 * X - above_congruent(X, A);
  lower.diagonal() -= diagonal_above(2 * kUnit * lower.cwiseAbs(), X);
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
  const MatrixXd below = J.transpose() * below_inverse(G) * J;  // only moves and negates entries
  MatrixXd R = (G - below) / 2;
  R.diagonal() += diagonal_above(2 * kUnit * (G.cwiseAbs() + below.cwiseAbs()), G);
  const MatrixXd M = (G + below) / 2;
  MatrixXd T(g, 2 * g);
  T << MatrixXd::Identity(g, g), -Z;
  // x R x for each row x of T = [1, -Z]; then tr(Y R_bb), its rounding added.
  const VectorXd across = above_congruent(T, R).diagonal().cwiseMax(0);
  const MatrixXd products = bounds.upper.cwiseAbs() * R.bottomRightCorner(g, g).cwiseAbs();
  const double trace = std::max(0.0, (bounds.upper * R.bottomRightCorner(g, g)).trace()) +
                       kUnit * static_cast<double>(2 * g + 1) * products.trace();
  // The part of the midpoint M: |rest Y|_ij <= sum_k |rest_ik| sqrt(Y_kk Y_jj), since Y is positive definite.
  const MatrixXd rest = T * M.rightCols(g);
  const double factor = kUnit * static_cast<double>(2 * g + 2);
  const MatrixXd missed = rest.cwiseAbs() + slack(2 * g) * factor * (T.cwiseAbs() * M.rightCols(g).cwiseAbs());
  const VectorXd root = bounds.upper.diagonal().cwiseSqrt();
  bounds.real_lower.resize(g, g);
  bounds.real_upper.resize(g, g);
  for (Index i = 0; i < g; ++i) {
    for (Index j = 0; j < g; ++j) {
      const double radius =
          slack(2 * g) * (std::sqrt(across[i] * trace) * root[j] + missed.row(i).dot(root) * root[j]) +
          2 * kUnit * std::abs(Z(i, j));
      bounds.real_lower(i, j) = -Z(i, j) - radius;
      bounds.real_upper(i, j) = -Z(i, j) + radius;
    }
  }
  // Omega is symmetric: the narrower of both intervals holds for both entries.
  bounds.real_lower = bounds.real_lower.cwiseMax(bounds.real_lower.transpose()).eval();
  bounds.real_upper = bounds.real_upper.cwiseMin(bounds.real_upper.transpose()).eval();
}

}  // namespace

PeriodBounds period_bounds(const MatrixXd& G) {
  const Index g = G.rows() / 2;
  PeriodBounds bounds;
  bounds.lower = below_inverse(G.bottomRightCorner(g, g));
  // Any Z gives an upper bound; this one is the best, up to rounding.
  const MatrixXd Z = G.topRightCorner(g, g) * bounds.lower;
  MatrixXd T(g, 2 * g);
  T << MatrixXd::Identity(g, g), -Z;
  bounds.upper = above_congruent(T, G);
  set_real_bounds(G, Z, bounds);
  return bounds;
}

}  // namespace holomorph::conformal
