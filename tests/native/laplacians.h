// Small systems for the tests of the solver, and Eigen's dense solution of them.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "solver/solver_choice.h"

namespace holomorph::solver {

enum class Shape { sheet, torus };

/// The Laplacian of a grid of width x height vertices, with diagonals, and weights from 0.1 to 2 that follow from
/// `seed`.
Laplacian grid_laplacian(int width, int height, Shape shape = Shape::torus, unsigned seed = 1);

/// A copy: solvers take theirs apart.
inline Laplacian copy_of(const Laplacian& L) { return L; }

/// #V x columns, from -1 to 1, the same for the same seed everywhere.
Eigen::MatrixXd random_values(Eigen::Index rows, Eigen::Index columns, unsigned seed);

/// Each column without its mean: a right-hand side for Condition::natural, and the solution that is compared.
Eigen::MatrixXd centred(const Eigen::MatrixXd& X);

/// Largest |B - L X| / |B| over the columns, at the vertices that are not fixed.
double relative_residual(const Laplacian& L, const Eigen::MatrixXd& X, const Eigen::MatrixXd& B,
                         const std::vector<int>& fixed = {});

/// By an eigendecomposition, 0 at the fixed vertices; of mean 0 where there are none.
struct DenseSolution {
  Eigen::MatrixXd X;
  double least_eigenvalue;  ///< least eigenvalue of what was inverted: |X - Y| <= |B - L Y| / least_eigenvalue
};
DenseSolution dense_solution(const Laplacian& L, const Eigen::MatrixXd& B, const std::vector<int>& fixed = {});

/// The same for a positive definite matrix, by the dense Cholesky method.
Eigen::MatrixXd positive_solution(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B,
                                  const std::vector<int>& fixed = {});

/// Whether each bit is the same.
bool same_bits(const Eigen::MatrixXd& X, const Eigen::MatrixXd& Y);

}  // namespace holomorph::solver
