#include "forms/holomorphic_basis.h"

#include "linear/blas.h"

namespace holomorph::forms {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using topology::IntegerMatrix;

// A basis of the integer classes of the double, in rows (x, y). Each is (s(x) + a(y)) / 2, with x an integer
// combination of the natural classes and y of the Dirichlet classes, s and a their symmetric and antisymmetric
// extensions, and x = E y mod 2. E takes a handle class to itself and d(1 on a loop) to 0 (docs/method/boundaries.md).
// On planar surfaces the basis is canonical up to its order: alpha_k = a(d_k) / 2, beta_k = -s(n_k).
IntegerMatrix double_classes(Index n, Index handles) {
  IntegerMatrix rows = IntegerMatrix::Zero(2 * n, 2 * n);
  Index row = 0;
  for (Index k = handles; k < n; ++k) {
    // A loop: E takes it to 0, so y is any integer and x is even.
    rows(row++, n + k) = 1;
    rows(row++, k) = -2;
  }
  for (Index k = 0; k < handles; ++k) {
    // A handle: x = y mod 2.
    rows(row, k) = 1;
    rows(row++, n + k) = 1;
    rows(row++, k) = 2;
  }
  return rows;
}

// The double carries the metric of both halves: its Gram matrix is (x G_N x^T + y G_D y^T) / 2, its wedge matrix
// (x W y'^T - y W^T x'^T) / 2, integer and unimodular on the classes above. Rows (x, y) of a canonical basis.
MatrixXd canonical_classes_of_double(const IntegerMatrix& W, Index handles) {
  const Index n = W.rows();
  const IntegerMatrix basis = double_classes(n, handles), x = basis.leftCols(n), y = basis.rightCols(n);
  const IntegerMatrix xWy = topology::product(x, topology::product(y, W.transpose()).transpose());
  return topology::product(topology::symplectic_basis((xWy - xWy.transpose()) / 2), basis).cast<double>();
}

MatrixXd gram_of_double(const MatrixXd& classes, const MatrixXd& G_N, const MatrixXd& G_D) {
  const Index n = G_N.rows();
  const MatrixXd x = classes.leftCols(n), y = classes.rightCols(n);
  return symmetric(linear::congruent(x, G_N) + linear::congruent(y, G_D)) / 2;
}

}  // namespace

HolomorphicBasis closed_basis(const MatrixXd& G, const MatrixXd& certain, const IntegerMatrix& W,
                              const topology::CanonicalBasis& canonical, Execution& execution) {
  const auto g = G.rows() / 2;
  const MatrixXd S = canonical.classes.cast<double>();
  // The rows of S are alpha and beta, written in the classes that the forms belong to.
  const auto in_canonical = [&S](const MatrixXd& gram) { return symmetric(linear::congruent(S, gram)); };
  HolomorphicBasis result;
  result.star = projected_star(G, G, W.cast<double>());
  execution.report(0.4);
  result.period_matrix = period_matrix(in_canonical(result.star.natural_gram));
  MatrixXcd periods(2 * g, g);  // int_{a_i} theta_j = delta_ij, int_{b_i} theta_j = Omega_ij
  periods << MatrixXcd::Identity(g, g), result.period_matrix;
  result.differentials = S.transpose() * periods;  // zeta = R^-1 (a, b), and R^-1 = S^T
  const MatrixXd in_classes = above_congruent(S, certain);
  execution.report(0.6);
  result.bounds = period_bounds(in_classes, execution);
  return result;
}

HolomorphicBasis bounded_basis(const std::vector<MatrixXd>& gram, const std::vector<MatrixXd>& certain,
                               const IntegerMatrix& W, int genus, Execution& execution) {
  const Index n = W.rows();
  HolomorphicBasis result;
  result.star = projected_star(gram[0], gram[1], W.cast<double>());
  execution.report(0.2);
  result.differentials.resize(2 * n, n);
  result.differentials.topRows(n).setIdentity();
  // Column i has i C#_ij at the Dirichlet form j: the transpose of C#.
  result.differentials.bottomRows(n) =
      std::complex<double>(0, 1) * result.star.star.transpose().cast<std::complex<double>>();
  const MatrixXd classes = canonical_classes_of_double(W, 2 * genus);
  execution.report(0.3);
  result.period_matrix = period_matrix(gram_of_double(classes, result.star.natural_gram, result.star.dirichlet_gram));
  execution.report(0.4);
  MatrixXd both = MatrixXd::Zero(2 * n, 2 * n);
  both << certain[0], MatrixXd::Zero(n, n), MatrixXd::Zero(n, n), certain[1];
  // The double's Gram matrix is half of that of (x, y), as in gram_of_double. Halving is exact.
  const MatrixXd in_classes = above_congruent(classes, both) / 2;
  execution.report(0.5);
  result.bounds = period_bounds(in_classes, execution);
  return result;
}

}  // namespace holomorph::forms
