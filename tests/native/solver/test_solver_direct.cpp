#include <gtest/gtest.h>

#include "laplacians.h"
#include "solver/direct/direct_solver.h"

namespace holomorph::solver {
namespace {

// The promise of every solver, and the rounding of the dense solution that it is compared with.
double allowed_error(const DenseSolution& dense, const Eigen::MatrixXd& B) {
  return kResidual * B.norm() / dense.least_eigenvalue + 1e-12 * dense.X.norm();
}

std::vector<int> every(int step, int size) {
  std::vector<int> result;
  for (int v = 0; v < size; v += step) result.push_back(v);
  return result;
}

TEST(DirectSolver, NaturalSolutionIsTheDenseOneUpToAConstant) {
  Execution execution(2);
  for (const Shape shape : {Shape::sheet, Shape::torus}) {
    const Laplacian L = grid_laplacian(17, 14, shape);
    const Eigen::MatrixXd B = centred(random_values(L.size(), 5, 2));
    const DenseSolution dense = dense_solution(L, B);
    const auto solver = make_direct_solver(copy_of(L), {}, execution);
    const Eigen::MatrixXd X = solver->solve(B, Condition::natural, execution);
    EXPECT_LE((centred(X) - dense.X).norm(), allowed_error(dense, B));
    EXPECT_LE(relative_residual(L, X, B), kResidual);
    EXPECT_LE(solver->residual(), kResidual);
  }
}

class FixedVertices : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Every, FixedVertices, testing::Values(1, 2, 3, 20, 100, 1000));

TEST_P(FixedVertices, SolutionIsTheDenseOneAndExactlyZeroThere) {
  Execution execution(2);
  const Laplacian L = grid_laplacian(17, 14, Shape::sheet);
  const std::vector<int> fixed = every(GetParam(), L.size());
  const Eigen::MatrixXd B = random_values(L.size(), 3, 3);
  const auto solver = make_direct_solver(copy_of(L), fixed, execution);
  const Eigen::MatrixXd X = solver->solve(B, Condition::dirichlet, execution);
  for (const int v : fixed) EXPECT_EQ(X.row(v).cwiseAbs().maxCoeff(), 0.0);
  if (static_cast<int>(fixed.size()) == L.size()) return;
  const DenseSolution dense = dense_solution(L, B, fixed);
  EXPECT_LE((X - dense.X).norm(), allowed_error(dense, B));
  EXPECT_LE(relative_residual(L, X, B, fixed), kResidual);
}

TEST_P(FixedVertices, OneFactorisationServesBothConditions) {
  Execution execution(2);
  const Laplacian L = grid_laplacian(17, 14, Shape::torus);
  const std::vector<int> fixed = every(GetParam(), L.size());
  const Eigen::MatrixXd B = centred(random_values(L.size(), 4, 4));
  const std::vector<Condition> conditions = {Condition::natural, Condition::dirichlet, Condition::dirichlet,
                                             Condition::natural};
  const auto solver = make_direct_solver(copy_of(L), fixed, execution);
  const Eigen::MatrixXd X = solver->solve(B, conditions, execution);
  const DenseSolution natural = dense_solution(L, B);
  for (const int column : {0, 3}) {
    EXPECT_LE((centred(X.col(column)) - natural.X.col(column)).norm(), allowed_error(natural, B));
  }
  if (static_cast<int>(fixed.size()) == L.size()) return;
  const DenseSolution dirichlet = dense_solution(L, B, fixed);
  EXPECT_LE((X - dirichlet.X).middleCols(1, 2).norm(), allowed_error(dirichlet, B));
}

TEST(DirectSolver, AVertexAlone) {
  Execution execution(1);
  Laplacian L;
  L.starts = {0, 1};
  L.columns = {0};
  L.weights = {0.0};
  const auto solver = make_direct_solver(std::move(L), {}, execution);
  const Eigen::MatrixXd X = solver->solve(Eigen::MatrixXd::Zero(1, 2), Condition::natural, execution);
  EXPECT_EQ(X, Eigen::MatrixXd::Zero(1, 2));
}

}  // namespace
}  // namespace holomorph::solver
