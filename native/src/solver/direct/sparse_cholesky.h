// One sparse Cholesky factorisation, from whichever library is there.
#pragma once

#include <Eigen/SparseCore>
#include <memory>
#include <string>
#include <vector>

namespace holomorph::solver {

/// Factorises a positive definite matrix given by its lower triangle. CHOLMOD's supernodal method with AMD ordering,
/// its BLAS on one thread (so that the bits do not depend on the number of threads); else Eigen's simplicial LDL^T.
///
/// Some unknowns may be `fixed`: they are eliminated after all others. Then the factor of the matrix without them is a
/// part of the factor of the whole, and both systems are solved with one factorisation. Where that would be slow,
/// because too many are fixed, and with Eigen's method there are two.
class SparseCholesky {
 public:
  SparseCholesky();
  ~SparseCholesky();
  SparseCholesky(const SparseCholesky&) = delete;
  SparseCholesky& operator=(const SparseCholesky&) = delete;

  /// @param fixed one flag per unknown, or empty for none
  /// @throws SolverError if the matrix is not positive definite or memory runs out
  void compute(const Eigen::SparseMatrix<double>& lower, std::vector<char> fixed);
  /// The solution of the whole system.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& B);
  /// The solution that is 0 at the fixed unknowns, of the equations of the others.
  Eigen::MatrixXd solve_fixed(const Eigen::MatrixXd& B);

  static std::string name();
  /// Whether it is CHOLMOD's supernodal method, several times faster than the other on large systems.
  static bool supernodal();

 private:
  struct Factor;
  void factorise(const Eigen::SparseMatrix<double>& lower);
  void count_solution(const Eigen::MatrixXd& B) const;
  std::unique_ptr<Factor> factor_, factor_of_others_;  // the second one only where there are two
  std::vector<char> fixed_;
  std::vector<Eigen::Index> others_;  // that are not fixed, with two factors
};

}  // namespace holomorph::solver
