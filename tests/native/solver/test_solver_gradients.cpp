#include <gtest/gtest.h>

#include "laplacians.h"
#include "solver/conjugate_gradients.h"

namespace holomorph::solver {
namespace {

class Gradients : public testing::TestWithParam<Scaling> {
 protected:
  GradientOptions options() const { return {.scaling = GetParam()}; }
};
INSTANTIATE_TEST_SUITE_P(Scalings, Gradients, testing::Values(Scaling::none, Scaling::diagonal));

TEST_P(Gradients, SolveLikeTheDenseMethod) {
  Execution execution(2);
  for (const Shape shape : {Shape::sheet, Shape::torus}) {
    const Laplacian L = grid_laplacian(19, 13, shape);
    for (const int columns : {1, 2, 3, 4, 5, 8, 9, 13}) {  // blocks of every width
      const Eigen::MatrixXd B = centred(random_values(L.size(), columns, columns));
      Eigen::MatrixXd X = Eigen::MatrixXd::Zero(L.size(), columns);
      const GradientReport report = conjugate_gradients(L, B, X, options(), execution);
      const DenseSolution dense = dense_solution(L, B);
      EXPECT_TRUE(report.converged);
      EXPECT_LE(report.residual, kResidual);
      EXPECT_LE(relative_residual(L, X, B), 1.01 * kResidual);  // computed anew, in another order
      EXPECT_LE((centred(X) - dense.X).norm(), kResidual * B.norm() / dense.least_eigenvalue);
    }
  }
}

TEST_P(Gradients, NeverPassMostIterations) {
  const Laplacian L = grid_laplacian(40, 40);
  const Eigen::MatrixXd B = centred(random_values(L.size(), 3, 1));
  Execution execution(2);
  for (const int most : {0, 1, 2, 7}) {
    GradientOptions few = options();
    few.most_iterations = most;
    Eigen::MatrixXd X = Eigen::MatrixXd::Zero(L.size(), 3);
    const GradientReport report = conjugate_gradients(L, B, X, few, execution);
    EXPECT_EQ(report.iterations, most);
    EXPECT_FALSE(report.converged);
    EXPECT_FALSE(report.is_rounding);
    EXPECT_NEAR(report.residual, relative_residual(L, X, B), 1e-12);
  }
}

TEST_P(Gradients, AGoalOutOfReachEnds) {
  const Laplacian L = grid_laplacian(20, 20);
  const Eigen::MatrixXd B = centred(random_values(L.size(), 2, 2));
  GradientOptions unreachable = options();
  unreachable.residual = 1e-30;
  unreachable.most_iterations = 5000;
  Eigen::MatrixXd X = Eigen::MatrixXd::Zero(L.size(), 2);
  Execution execution(1);
  const GradientReport report = conjugate_gradients(L, B, X, unreachable, execution);
  EXPECT_FALSE(report.converged);
  // A fifth of the limit, or five times as much: the residual is rounded itself.
  const Eigen::MatrixXd terms = L.matrix().cwiseAbs() * X.cwiseAbs() + B.cwiseAbs();
  const double left = ((B - L.matrix() * X).colwise().norm().array() / terms.colwise().norm().array()).maxCoeff();
  EXPECT_LE(left < 0.2e-14, report.is_rounding);
  EXPECT_LE(report.is_rounding, left < 5e-14);
  EXPECT_LE(report.iterations, unreachable.most_iterations);
  EXPECT_TRUE(X.allFinite());
}

TEST_P(Gradients, BeginWithTheGivenValues) {
  const Laplacian L = grid_laplacian(20, 20);
  const Eigen::MatrixXd B = centred(random_values(L.size(), 2, 3));
  Eigen::MatrixXd X = Eigen::MatrixXd::Zero(L.size(), 2);
  Execution execution(2);
  conjugate_gradients(L, B, X, options(), execution);
  const Eigen::MatrixXd before = X;
  EXPECT_EQ(conjugate_gradients(L, B, X, options(), execution).iterations, 0);
  EXPECT_TRUE(same_bits(X, before));
}

TEST_P(Gradients, ARightHandSideOfZerosStaysZero) {
  const Laplacian L = grid_laplacian(20, 20);
  Eigen::MatrixXd B = centred(random_values(L.size(), 3, 4)), X = Eigen::MatrixXd::Zero(L.size(), 3);
  B.col(1).setZero();
  Execution execution(2);
  EXPECT_TRUE(conjugate_gradients(L, B, X, options(), execution).converged);
  EXPECT_EQ(X.col(1).cwiseAbs().maxCoeff(), 0.0);
}

TEST_P(Gradients, AreCancelled) {
  const Laplacian L = grid_laplacian(20, 20);
  const Eigen::MatrixXd B = centred(random_values(L.size(), 1, 5));
  Eigen::MatrixXd X = Eigen::MatrixXd::Zero(L.size(), 1);
  Execution cancelled(2, [](double, const std::string&) { return false; });
  EXPECT_THROW(conjugate_gradients(L, B, X, options(), cancelled), Cancelled);
}

TEST_P(Gradients, BitsDoNotDependOnTheThreads) {
  const Laplacian L = grid_laplacian(180, 120);  // several chunks
  const Eigen::MatrixXd B = centred(random_values(L.size(), 3, 6));
  GradientOptions few = options();
  few.most_iterations = 40;
  const auto solved = [&](int threads) {
    Execution execution(threads);
    Eigen::MatrixXd X = Eigen::MatrixXd::Zero(L.size(), 3);
    conjugate_gradients(L, B, X, few, execution);
    return X;
  };
  const Eigen::MatrixXd one = solved(1);
  for (const int threads : {2, 4, 8}) EXPECT_TRUE(same_bits(one, solved(threads)));
}

}  // namespace
}  // namespace holomorph::solver
