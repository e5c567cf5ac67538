#include "conformal/bounded_basis.h"

namespace holomorph::conformal {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using topology::IntegerMatrix;

// The integer classes of the double: (s(x) + a(y)) / 2, x an integer combination of the N classes and y of the D
// classes, s and a their symmetric and antisymmetric extension, x = E y mod 2, where E takes a handle class to itself
// and d(1 on a loop) to 0. Rows (x, y) of a basis, in such an order that on planar surfaces it is canonical up to the
// order, alpha_k = a(d_k) / 2, beta_k = -s(n_k).
IntegerMatrix double_classes(Index n, Index handles) {
  IntegerMatrix rows = IntegerMatrix::Zero(2 * n, 2 * n);
  Index row = 0;
  for (Index k = handles; k < n; ++k) {
    rows(row++, n + k) = 1;
    rows(row++, k) = -2;
  }
  for (Index k = 0; k < handles; ++k) {
    rows(row, k) = 1;
    rows(row++, n + k) = 1;
    rows(row++, k) = 2;
  }
  return rows;
}

// The double carries the metric of both halves: its Gram matrix is (x G_N x^T + y G_D y^T) / 2, its wedge matrix
// (x W y'^T - y W^T x'^T) / 2, integer and unimodular on the classes above.
Eigen::MatrixXcd period_matrix_of_double(const ProjectedStar& projected, const IntegerMatrix& W, Index handles) {
  const Index n = W.rows();
  const IntegerMatrix basis = double_classes(n, handles);
  const IntegerMatrix x = basis.leftCols(n), y = basis.rightCols(n), xWy = x * W * y.transpose();
  const MatrixXd S = topology::symplectic_basis((xWy - xWy.transpose()) / 2).cast<double>();
  const MatrixXd Sx = S * x.cast<double>(), Sy = S * y.cast<double>();
  const MatrixXd G =
      (Sx * projected.natural_gram * Sx.transpose() + Sy * projected.dirichlet_gram * Sy.transpose()) / 2;
  const MatrixXd imaginary = symmetric(inverse(G.bottomRightCorner(n, n)));
  const MatrixXd real = symmetric(-G.topRightCorner(n, n) * imaginary);
  return real.cast<std::complex<double>>() + std::complex<double>(0, 1) * imaginary.cast<std::complex<double>>();
}

}  // namespace

BoundedBasis bounded_basis(const MatrixXd& G_N, const MatrixXd& G_D, const IntegerMatrix& W, int genus) {
  const Index n = W.rows();
  BoundedBasis result;
  result.projected = projected_star(G_N, G_D, W.cast<double>());
  result.coefficients.resize(2 * n, n);
  result.coefficients.topRows(n).setIdentity();
  result.coefficients.bottomRows(n) =
      std::complex<double>(0, 1) * result.projected.star.transpose().cast<std::complex<double>>();
  result.period_matrix = period_matrix_of_double(result.projected, W, 2 * genus);
  return result;
}

}  // namespace holomorph::conformal
