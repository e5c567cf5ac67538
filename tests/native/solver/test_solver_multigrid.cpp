#include <gtest/gtest.h>

#include <cmath>

#include "laplacians.h"
#include "solver/direct/direct_solver.h"
#include "solver/multigrid/cycle.h"
#include "solver/multigrid/multigrid_solver.h"

namespace holomorph::solver {
namespace {

// Error of sums in single precision, relative to the energies of both: the preconditioner is symmetric up to this.
constexpr double kSinglePrecision = 1e-5;

// One cycle for K right-hand sides, as a matrix.
template <int K>
class CycleMatrix {
 public:
  CycleMatrix(const Laplacian& L, const std::vector<int>& fixed, int threads)
      : execution_(threads), hierarchy_(make_hierarchy(L, fixed, execution_)) {}

  int levels() const { return static_cast<int>(hierarchy_.levels.size()); }

  // M R for the first columns of R. @param natural 1, or 0 for the right-hand sides that are fixed
  Eigen::MatrixXd operator()(const Eigen::MatrixXd& R, const Block<K>& natural = Block<K>::Ones()) {
    Cycle<K> cycle(hierarchy_, execution_.workers());
    cycle.set_conditions(natural);
    for (Eigen::Index i = 0; i < R.rows(); ++i) {
      Block<K> r = Block<K>::Zero();
      for (Eigen::Index k = 0; k < R.cols(); ++k) r[k] = static_cast<float>(R(i, k));
      cycle.step()[i] = jacobi_step<K>(hierarchy_.levels[0].op.omega[i], r, natural);
    }
    cycle.run([](int, Rows) {});
    Eigen::MatrixXd Z(R.rows(), R.cols());
    for (Eigen::Index i = 0; i < R.rows(); ++i) {
      for (Eigen::Index k = 0; k < R.cols(); ++k) Z(i, k) = cycle.result()[i][k];
    }
    return Z;
  }

 private:
  Execution execution_;
  Hierarchy hierarchy_;
};

// X^T M X is symmetric and positive definite for random X.
void expect_symmetric_and_positive(const Eigen::MatrixXd& X, const Eigen::MatrixXd& MX) {
  const Eigen::MatrixXd energy = X.transpose() * MX;
  for (Eigen::Index i = 0; i < energy.rows(); ++i) {
    EXPECT_GT(energy(i, i), 0.0);
    for (Eigen::Index j = 0; j < i; ++j) {
      EXPECT_NEAR(energy(i, j), energy(j, i), kSinglePrecision * std::sqrt(energy(i, i) * energy(j, j)));
    }
  }
}

template <class Width>
class CycleOf : public testing::Test {};
using Widths =
    testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 4>, std::integral_constant<int, 8>>;
TYPED_TEST_SUITE(CycleOf, Widths);

TYPED_TEST(CycleOf, IsSymmetricAndPositiveUpToConstants) {
  constexpr int K = TypeParam::value;
  for (const auto& [width, height, shape] :
       {std::tuple(10, 12, Shape::torus), std::tuple(70, 61, Shape::torus), std::tuple(80, 100, Shape::sheet)}) {
    const Laplacian L = grid_laplacian(width, height, shape);
    CycleMatrix<K> M(L, {}, 2);
    const Eigen::MatrixXd X = centred(random_values(L.size(), K, 7));
    expect_symmetric_and_positive(X, M(X));
  }
}

TYPED_TEST(CycleOf, IsSymmetricAndPositiveAtTheVerticesThatAreNotFixed) {
  constexpr int K = TypeParam::value;
  const Laplacian L = grid_laplacian(70, 61, Shape::sheet);
  std::vector<int> fixed;
  for (int v = 0; v < L.size(); v += 13) fixed.push_back(v);
  CycleMatrix<K> M(L, fixed, 2);
  Eigen::MatrixXd X = random_values(L.size(), K, 8);
  X(fixed, Eigen::all).setZero();
  const Eigen::MatrixXd MX = M(X, Block<K>::Zero());
  EXPECT_EQ(MX(fixed, Eigen::all).cwiseAbs().maxCoeff(), 0.0);
  expect_symmetric_and_positive(X, MX);
}

TYPED_TEST(CycleOf, IsLinear) {
  constexpr int K = TypeParam::value;
  const Laplacian L = grid_laplacian(70, 61);
  CycleMatrix<K> M(L, {}, 2);
  const Eigen::MatrixXd X = centred(random_values(L.size(), K, 9)), Y = centred(random_values(L.size(), K, 10));
  const Eigen::MatrixXd expected = 2 * M(X) - 3 * M(Y);
  EXPECT_LE((M(2 * X - 3 * Y) - expected).norm(), kSinglePrecision * expected.norm());
}

TYPED_TEST(CycleOf, BitsDoNotDependOnTheThreads) {
  constexpr int K = TypeParam::value;
  const Laplacian L = grid_laplacian(150, 131);
  const Eigen::MatrixXd X = centred(random_values(L.size(), K, 11));
  CycleMatrix<K> one(L, {}, 1);
  EXPECT_GE(one.levels(), 3);
  const Eigen::MatrixXd expected = one(X);
  for (const int threads : {2, 4, 8}) {
    CycleMatrix<K> M(L, {}, threads);
    for (int run = 0; run < 3; ++run) EXPECT_TRUE(same_bits(M(X), expected));
  }
}

TEST(Cycle, IsTheInverseWhereThereIsOneLevel) {
  const Laplacian L = grid_laplacian(12, 13);
  CycleMatrix<2> M(L, {}, 1);
  ASSERT_EQ(M.levels(), 1);
  const Eigen::MatrixXd B = centred(random_values(L.size(), 2, 12));
  const DenseSolution dense = dense_solution(L, B);
  EXPECT_LE((centred(M(B)) - dense.X).norm(), kSinglePrecision * B.norm() / dense.least_eigenvalue);
}

class MultigridSolverOf : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Threads, MultigridSolverOf, testing::Values(1, 2, 4));

TEST_P(MultigridSolverOf, AgreesWithTheDirectOne) {
  const Laplacian L = grid_laplacian(90, 77, Shape::sheet);
  std::vector<int> fixed;
  for (int v = 5; v < L.size(); v += 29) fixed.push_back(v);
  const Eigen::MatrixXd B = centred(random_values(L.size(), 11, 13));  // columns of every width
  std::vector<Condition> conditions(11, Condition::natural);
  for (const int column : {1, 2, 8}) conditions[column] = Condition::dirichlet;
  Execution execution(GetParam());
  const auto multigrid = make_multigrid_solver(copy_of(L), fixed, kResidual, execution);
  const auto direct = make_direct_solver(copy_of(L), fixed, execution);
  const Eigen::MatrixXd X = multigrid->solve(B, conditions, execution), Y = direct->solve(B, conditions, execution);
  EXPECT_EQ(multigrid->remark(), "");
  EXPECT_LE(multigrid->residual(), kResidual);
  for (Eigen::Index column = 0; column < B.cols(); ++column) {
    const bool natural = conditions[column] == Condition::natural;
    const std::vector<int> none;
    EXPECT_LE(relative_residual(L, X.col(column), B.col(column), natural ? none : fixed), 1.01 * kResidual);
    const Eigen::VectorXd difference = natural ? centred((X - Y).col(column)) : Eigen::MatrixXd((X - Y).col(column));
    EXPECT_LE(difference.norm(), 1e-6 * Y.col(column).norm());  // the residual times the condition number
  }
}

TEST_P(MultigridSolverOf, HasTheBitsOfOneThread) {
  const Laplacian L = grid_laplacian(150, 131);
  const Eigen::MatrixXd B = centred(random_values(L.size(), 3, 14));
  const auto solved = [&](int threads) {
    Execution execution(threads);
    return Eigen::MatrixXd(
        make_multigrid_solver(copy_of(L), {}, kGoal, execution)->solve(B, Condition::natural, execution));
  };
  EXPECT_TRUE(same_bits(solved(GetParam()), solved(1)));
}

TEST(MultigridSolver, IsCancelledInTheMiddle) {
  const Laplacian L = grid_laplacian(150, 131);
  const Eigen::MatrixXd B = centred(random_values(L.size(), 8, 15));
  bool go_on = true;
  Execution execution(2, [&](double, const std::string&) { return go_on; });
  const auto solver = make_multigrid_solver(copy_of(L), {}, kGoal, execution);
  std::this_thread::sleep_for(std::chrono::milliseconds(25));  // the next report is heard
  go_on = false;
  EXPECT_THROW(solver->solve(B, Condition::natural, execution), Cancelled);
  go_on = true;
  EXPECT_LE(relative_residual(L, solver->solve(B, Condition::natural, execution), B), kResidual);
}

}  // namespace
}  // namespace holomorph::solver
