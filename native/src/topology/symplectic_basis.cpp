#include "topology/symplectic_basis.h"

#include <cmath>
#include <cstdlib>
#include <utility>

#include "base/errors.h"

namespace holomorph::topology {
namespace {

constexpr double kLargest = 0x1p62;  // half of what fits: the bound below is rounded

std::int64_t checked_subtract_product(std::int64_t a, std::int64_t factor, std::int64_t b) {
  const double bound =
      std::abs(static_cast<double>(a)) + std::abs(static_cast<double>(factor) * static_cast<double>(b));
  if (bound > kLargest) throw Error("the canonical homology basis needs integers beyond 62 bits");
  return a - factor * b;
}

// Rows of S, and their products W(i, j) = S_i W S_j^T, kept up to date. Every step is a unimodular change of the rows.
class GramSchmidt {
 public:
  explicit GramSchmidt(const IntegerMatrix& W) : n_(W.rows()), rows_(IntegerMatrix::Identity(n_, n_)), W_(W) {}

  IntegerMatrix run() {
    for (Eigen::Index k = 0; k < n_; k += 2) {
      pair_ = k;
      make_pair(k);
      for (Eigen::Index i = k + 2; i < n_; ++i) {
        const std::int64_t with_e = W_(i, k), with_f = W_(i, k + 1);
        subtract(i, with_f, k);  // S_i - (S_i, f) e + (S_i, e) f is orthogonal to e and f, since (e, f) = 1
        subtract(i, -with_e, k + 1);
      }
    }
    IntegerMatrix S(n_, n_);
    for (Eigen::Index i = 0; i < n_ / 2; ++i) {
      S.row(i) = rows_.row(2 * i);
      S.row(n_ / 2 + i) = rows_.row(2 * i + 1);
    }
    return S;
  }

 private:
  // Makes (S_k, S_k+1) = 1: Euclid's algorithm on the products with S_k, whose greatest common divisor is 1.
  void make_pair(Eigen::Index k) {
    for (;;) {
      Eigen::Index least = -1, other = -1;
      for (Eigen::Index i = k + 1; i < n_; ++i) {
        if (W_(k, i) == 0) continue;
        if (least < 0 || std::abs(W_(k, i)) < std::abs(W_(k, least)))
          other = std::exchange(least, i);
        else if (other < 0)
          other = i;
      }
      if (least < 0) throw Error("the wedge matrix of the classes is not unimodular");
      if (std::abs(W_(k, least)) == 1) {
        swap(k + 1, least);
        if (W_(k, k + 1) < 0) negate(k + 1);
        return;
      }
      if (other < 0) throw Error("the wedge matrix of the classes is not unimodular");
      // The rest of the division is smaller than the least product: Euclid's algorithm goes on with it, until the least
      // is 1.
      subtract(other, W_(k, other) / W_(k, least), least);
    }
  }

  void subtract(Eigen::Index i, std::int64_t factor, Eigen::Index j) {
    if (factor == 0) return;
    for (Eigen::Index c = 0; c < n_; ++c) rows_(i, c) = checked_subtract_product(rows_(i, c), factor, rows_(j, c));
    // W stays the matrix of the products S_i W S_j^T, antisymmetric. Pairs before `pair_` are orthogonal to all rows.
    for (Eigen::Index c = pair_; c < n_; ++c) {
      if (W_(j, c) == 0 || c == i) continue;
      W_(i, c) = checked_subtract_product(W_(i, c), factor, W_(j, c));
      W_(c, i) = -W_(i, c);
    }
  }

  void swap(Eigen::Index i, Eigen::Index j) {
    if (i == j) return;
    rows_.row(i).swap(rows_.row(j));
    W_.row(i).swap(W_.row(j));
    W_.col(i).swap(W_.col(j));
  }

  void negate(Eigen::Index i) {
    rows_.row(i) *= -1;
    W_.row(i) *= -1;
    W_.col(i) *= -1;
  }

  Eigen::Index n_, pair_ = 0;
  IntegerMatrix rows_, W_;
};

}  // namespace

IntegerMatrix product(const IntegerMatrix& A, const IntegerMatrix& B) {
  IntegerMatrix C = IntegerMatrix::Zero(A.rows(), B.cols());
  for (Eigen::Index i = 0; i < A.rows(); ++i) {
    for (Eigen::Index k = 0; k < A.cols(); ++k) {
      if (A(i, k) == 0) continue;
      for (Eigen::Index j = 0; j < B.cols(); ++j) C(i, j) = checked_subtract_product(C(i, j), -A(i, k), B(k, j));
    }
  }
  return C;
}

IntegerMatrix symplectic_basis(const IntegerMatrix& W) { return GramSchmidt(W).run(); }

CanonicalBasis canonical_basis(const IntegerMatrix& W) {
  const auto g = W.rows() / 2;
  CanonicalBasis basis;
  basis.classes = symplectic_basis(W);
  const IntegerMatrix& S = basis.classes;
  IntegerMatrix JS(2 * g, 2 * g);
  JS << S.bottomRows(g), -S.topRows(g);
  basis.intersection = product(S.transpose(), JS);  // -W^-1 = S^T J S, because S W S^T = J
  basis.cycles = product(-JS, W);                   // S^-T = -J S W, likewise
  return basis;
}

}  // namespace holomorph::topology
