// Dense decompositions of small matrices, compiled once: Eigen's templates for them take seconds in each unit.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "linear/blas.h"

namespace holomorph::linear {

/// A = L L^H of a Hermitian positive definite matrix, real or complex; it reads the lower half of A alone.
template <class Matrix>
class Cholesky {
 public:
  using Vector = Eigen::Matrix<typename Matrix::Scalar, Eigen::Dynamic, 1>;

  explicit Cholesky(const Matrix& A);

  /// Whether A is positive definite; if not, nothing else is defined.
  bool succeeded() const { return succeeded_; }
  Matrix lower() const;  ///< L
  Matrix upper() const;  ///< L^H
  Matrix solve(const Matrix& B) const;
  Vector solve(const Vector& b) const;
  Matrix solve_lower(const Matrix& B) const;  ///< L^-1 B
  Matrix inverse() const;                     ///< A^-1
  Matrix inverse_upper() const;               ///< L^-H

 private:
  Matrix factor_;  // L in the lower half
  bool succeeded_;
};
extern template class Cholesky<Eigen::MatrixXd>;
extern template class Cholesky<Eigen::MatrixXcd>;

/// Solves A x = b for a Hermitian matrix that need not be definite, by LDL^H with pivots.
Eigen::MatrixXd solve_symmetric(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);
Eigen::VectorXd solve_symmetric(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);
Eigen::VectorXcd solve_symmetric(const Eigen::MatrixXcd& A, const Eigen::VectorXcd& b);
Eigen::Vector2d solve_symmetric(const Eigen::Matrix2d& A, const Eigen::Vector2d& b);

/// Whether no pivot of LDL^T is negative: A is positive semi-definite, up to rounding.
bool is_positive(const Eigen::MatrixXd& A);

/// The eigenvalues of a symmetric matrix, ascending.
Eigen::VectorXd eigenvalues(const Eigen::MatrixXd& A);
/// The eigenvectors of a symmetric matrix by columns, ascending by eigenvalue.
Eigen::Matrix3d eigenvectors(const Eigen::Matrix3d& A);
/// Whether B - A is positive definite: x A x < x B x for all x.
bool is_below(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);
/// The largest x A x / x B x of symmetric matrices; none if B is not positive definite.
std::optional<double> greatest_quotient(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);
/// The symmetric root of a symmetric matrix; none if it is not positive definite.
std::optional<Eigen::MatrixXd> square_root(const Eigen::MatrixXd& A);

/// A^-1 and det A by LU with row pivots. @pre A is square and regular
Eigen::MatrixXd inverse(const Eigen::MatrixXd& A);
Eigen::MatrixXcd inverse(const Eigen::MatrixXcd& A);
double determinant(const Eigen::MatrixXd& A);
std::complex<double> determinant(const Eigen::MatrixXcd& A);

}  // namespace holomorph::linear
