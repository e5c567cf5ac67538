// Products and factors of dense matrices by BLAS and LAPACK where they are linked, and by Eigen where they are not.
#pragma once

#include <Eigen/Core>

namespace holomorph::linear {

/// While an instance is alive, BLAS runs on one thread, so that the bits do not depend on the number of threads. That
/// number belongs to the process: the destructor of the last instance restores it. Nor does the calling thread start
/// others by OpenMP: CHOLMOD would, for loops of microseconds, which cost a fifth of the time of a map.
class OneBlasThread {
 public:
  /// @throws std::bad_alloc where BLAS would wait for memory for ever
  OneBlasThread();
  ~OneBlasThread();
  OneBlasThread(const OneBlasThread&) = delete;
  OneBlasThread& operator=(const OneBlasThread&) = delete;

 private:
  int levels_ = 0;  // of parallel regions, before
};

/// Matrices of at most this many rows are left to Eigen: a call of BLAS costs more than it saves.
inline constexpr Eigen::Index kSmall = 32;
/// Likewise for Cholesky factors: the coarsest levels of multigrid are no larger, and Eigen's bits are the same on any
/// processor. On a ring of thin triangles OpenBLAS's lost two digits.
inline constexpr Eigen::Index kSmallFactor = 256;

/// A block of a matrix that is stored by columns.
using Block = Eigen::Ref<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>;

/// A B. Its cost is in proportion to the numbers of A other than 0 where these are few.
/// Any order of the sums has the same bound, |error|_ij <= n epsilon (|A| |B|)_ij with n summands (Higham 2002, 3.1).
Eigen::MatrixXd product(const Block& A, const Block& B);
/// T G T^T of a symmetric matrix G, not quite symmetric.
Eigen::MatrixXd congruent(const Eigen::MatrixXd& T, const Eigen::MatrixXd& G);
/// C += A B^T
void add_product_transposed(const Block& A, const Block& B, Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>> C);

/// A X and A^T Y of few columns: A is read from memory once.
Eigen::MatrixXd thin_product(const Eigen::MatrixXd& A, const Eigen::MatrixXd& X);
Eigen::MatrixXd thin_transposed_product(const Eigen::MatrixXd& A, const Eigen::MatrixXd& Y);

/// A = L L^T of a symmetric matrix, in its lower half, which alone is read. @return whether it is positive definite
bool factorise(Eigen::MatrixXd& A);
/// B = L^-1 B, or L^-T B, of a factor in a lower half.
void solve_lower(const Eigen::MatrixXd& L, Eigen::MatrixXd& B);
void solve_upper(const Eigen::MatrixXd& L, Eigen::MatrixXd& B);

/// Solves A X = B by LU with row pivots. @pre A is square and regular
Eigen::MatrixXd solve(Eigen::MatrixXd A, Eigen::MatrixXd B);

/// The eigenvalues of a symmetric matrix, ascending, and its eigenvectors by columns in its place.
/// @return whether they were found
bool decompose(Eigen::MatrixXd& A, Eigen::VectorXd& eigenvalues);

}  // namespace holomorph::linear
