#include "linear/dense.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <type_traits>

namespace holomorph::linear {

using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

namespace {

template <class Matrix>
constexpr bool kIsReal = std::is_same_v<Matrix, MatrixXd>;

}  // namespace

template <class Matrix>
Cholesky<Matrix>::Cholesky(const Matrix& A) {
  if constexpr (kIsReal<Matrix>) {
    factor_ = A;
    succeeded_ = factorise(factor_);
  } else {
    const Eigen::LLT<Matrix> factor(A);
    factor_ = factor.matrixLLT();
    succeeded_ = factor.info() == Eigen::Success;
  }
}

template <class Matrix>
Matrix Cholesky<Matrix>::lower() const {
  return factor_.template triangularView<Eigen::Lower>();
}

template <class Matrix>
Matrix Cholesky<Matrix>::upper() const {
  return factor_.adjoint().template triangularView<Eigen::Upper>();
}

template <class Matrix>
Matrix Cholesky<Matrix>::solve(const Matrix& B) const {
  Matrix X = B;
  if constexpr (kIsReal<Matrix>) {
    linear::solve_lower(factor_, X);
    linear::solve_upper(factor_, X);
  } else {
    factor_.template triangularView<Eigen::Lower>().solveInPlace(X);
    factor_.adjoint().template triangularView<Eigen::Upper>().solveInPlace(X);
  }
  return X;
}

template <class Matrix>
typename Cholesky<Matrix>::Vector Cholesky<Matrix>::solve(const Vector& b) const {
  Vector x = b;
  factor_.template triangularView<Eigen::Lower>().solveInPlace(x);
  factor_.adjoint().template triangularView<Eigen::Upper>().solveInPlace(x);
  return x;
}

template <class Matrix>
Matrix Cholesky<Matrix>::solve_lower(const Matrix& B) const {
  if constexpr (kIsReal<Matrix>) {
    Matrix X = B;
    linear::solve_lower(factor_, X);
    return X;
  } else {
    return factor_.template triangularView<Eigen::Lower>().solve(B);
  }
}

template <class Matrix>
Matrix Cholesky<Matrix>::inverse() const {
  return solve(Matrix(Matrix::Identity(factor_.rows(), factor_.cols())));
}

template <class Matrix>
Matrix Cholesky<Matrix>::inverse_upper() const {
  return factor_.adjoint().template triangularView<Eigen::Upper>().solve(
      Matrix::Identity(factor_.rows(), factor_.cols()));
}

template class Cholesky<MatrixXd>;
template class Cholesky<MatrixXcd>;

MatrixXd solve_symmetric(const MatrixXd& A, const MatrixXd& B) { return A.ldlt().solve(B); }
VectorXd solve_symmetric(const MatrixXd& A, const VectorXd& b) { return A.ldlt().solve(b); }
VectorXcd solve_symmetric(const MatrixXcd& A, const VectorXcd& b) { return A.ldlt().solve(b); }
Eigen::Vector2d solve_symmetric(const Eigen::Matrix2d& A, const Eigen::Vector2d& b) { return A.ldlt().solve(b); }

bool is_positive(const MatrixXd& A) { return Eigen::LDLT<MatrixXd>(A).isPositive(); }

VectorXd eigenvalues(const MatrixXd& A) {
  return Eigen::SelfAdjointEigenSolver<MatrixXd>(A, Eigen::EigenvaluesOnly).eigenvalues();
}

Eigen::Matrix3d eigenvectors(const Eigen::Matrix3d& A) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(A).eigenvectors();
}

bool is_below(const MatrixXd& A, const MatrixXd& B) {
  MatrixXd difference = B - A;
  return difference.allFinite() && factorise(difference);
}

std::optional<double> greatest_quotient(const MatrixXd& A, const MatrixXd& B) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> parts(A, B, Eigen::EigenvaluesOnly);
  if (parts.info() != Eigen::Success) return std::nullopt;
  return parts.eigenvalues().maxCoeff();
}

std::optional<MatrixXd> square_root(const MatrixXd& A) {
  MatrixXd V = A;
  VectorXd d;
  if (!A.allFinite() || !decompose(V, d) || !(d.minCoeff() > 0)) return std::nullopt;
  return product(V * d.cwiseSqrt().asDiagonal(), V.transpose());
}

MatrixXd inverse(const MatrixXd& A) { return A.inverse(); }
MatrixXcd inverse(const MatrixXcd& A) { return A.inverse(); }
double determinant(const MatrixXd& A) { return A.determinant(); }
std::complex<double> determinant(const MatrixXcd& A) { return A.determinant(); }

}  // namespace holomorph::linear
