#include "linear/dense.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>

namespace holomorph::linear {

using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

template <class Matrix>
Cholesky<Matrix>::Cholesky(const Matrix& A) {
  const Eigen::LLT<Matrix> factor(A);
  factor_ = factor.matrixLLT();
  succeeded_ = factor.info() == Eigen::Success;
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
  factor_.template triangularView<Eigen::Lower>().solveInPlace(X);
  factor_.adjoint().template triangularView<Eigen::Upper>().solveInPlace(X);
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
  return factor_.template triangularView<Eigen::Lower>().solve(B);
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

std::optional<double> greatest_quotient(const MatrixXd& A, const MatrixXd& B) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> parts(A, B, Eigen::EigenvaluesOnly);
  if (parts.info() != Eigen::Success) return std::nullopt;
  return parts.eigenvalues().maxCoeff();
}

std::optional<MatrixXd> square_root(const MatrixXd& A) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(A);
  if (eigen.info() != Eigen::Success || !(eigen.eigenvalues().minCoeff() > 0)) return std::nullopt;
  return eigen.operatorSqrt();
}

MatrixXd solve(const MatrixXd& A, const MatrixXd& B) { return A.partialPivLu().solve(B); }
MatrixXd inverse(const MatrixXd& A) { return A.inverse(); }
MatrixXcd inverse(const MatrixXcd& A) { return A.inverse(); }
double determinant(const MatrixXd& A) { return A.determinant(); }
std::complex<double> determinant(const MatrixXcd& A) { return A.determinant(); }

VectorXd least_squares(const MatrixXd& A, const VectorXd& b) { return A.householderQr().solve(b); }

}  // namespace holomorph::linear
