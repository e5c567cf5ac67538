// One sparse Cholesky factorisation, from whichever library is there.
#pragma once

#include <Eigen/SparseCore>
#include <memory>
#include <string>

namespace holomorph::solver {

/// Factorises a positive definite matrix given by its lower triangle. CHOLMOD's supernodal method with AMD ordering,
/// its BLAS on one thread (so that the bits do not depend on the number of threads); else Eigen's simplicial LDL^T.
class SparseCholesky {
 public:
  SparseCholesky();
  ~SparseCholesky();
  SparseCholesky(const SparseCholesky&) = delete;
  SparseCholesky& operator=(const SparseCholesky&) = delete;

  /// @throws SolverError if the matrix is not positive definite or memory runs out
  void compute(const Eigen::SparseMatrix<double>& lower);
  Eigen::MatrixXd solve(const Eigen::MatrixXd& B) const;

  static std::string name();
  /// Whether it is CHOLMOD's supernodal method, several times faster than the other on large systems.
  static bool supernodal();

 private:
  struct Factor;
  std::unique_ptr<Factor> factor_;
};

}  // namespace holomorph::solver
