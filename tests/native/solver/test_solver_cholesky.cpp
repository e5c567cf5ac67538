#include <gtest/gtest.h>

#include <thread>

#include "laplacians.h"
#include "solver/direct/sparse_cholesky.h"

#ifdef HOLOMORPH_WITH_OPENBLAS
extern "C" {
void openblas_set_num_threads(int);
int openblas_get_num_threads(void);
}
#endif

namespace holomorph::solver {
namespace {

// Error of rounding alone, for matrices of a condition number up to some hundred.
constexpr double kRounding = 1e-12;

using Matrix = Eigen::SparseMatrix<double>;

// A grid's Laplacian with the diagonal lifted: positive definite.
Matrix positive_matrix(int width, int height) {
  Matrix A = grid_laplacian(width, height).matrix();
  for (Eigen::Index i = 0; i < A.rows(); ++i) A.coeffRef(i, i) += 0.1;
  return A;
}

Matrix lower(const Matrix& A) { return A.triangularView<Eigen::Lower>(); }

TEST(SparseCholesky, SolvesLikeTheDenseMethod) {
  const Matrix A = positive_matrix(15, 12);
  const Eigen::MatrixXd B = random_values(A.rows(), 6, 1);
  SparseCholesky factor;
  factor.compute(lower(A), {});
  const Eigen::MatrixXd expected = positive_solution(A, B);
  EXPECT_LE((factor.solve(B) - expected).norm(), kRounding * expected.norm());
}

class FixedUnknowns : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Every, FixedUnknowns, testing::Values(1, 2, 7, 50, 179));

TEST_P(FixedUnknowns, BothSystemsAreSolved) {
  const Matrix A = positive_matrix(15, 12);
  const Eigen::MatrixXd B = random_values(A.rows(), 3, 2);
  std::vector<char> fixed(A.rows(), 0);
  std::vector<int> places;
  for (int i = 0; i < static_cast<int>(fixed.size()); i += GetParam()) {
    fixed[i] = 1;
    places.push_back(i);
  }
  SparseCholesky factor;
  factor.compute(lower(A), fixed);
  const Eigen::MatrixXd whole = positive_solution(A, B), part = positive_solution(A, B, places);
  EXPECT_LE((factor.solve(B) - whole).norm(), kRounding * whole.norm());
  const Eigen::MatrixXd X = factor.solve_fixed(B);
  EXPECT_LE((X - part).norm(), kRounding * part.norm());
  for (const int i : places) EXPECT_EQ(X.row(i).cwiseAbs().maxCoeff(), 0.0);
}

TEST(SparseCholesky, AnIndefiniteMatrixIsRefusedAndTheNextOneTaken) {
  const Matrix A = positive_matrix(8, 8);
  Matrix indefinite = A;
  indefinite.coeffRef(20, 20) = -1;
  SparseCholesky factor;
#ifdef HOLOMORPH_WITH_CHOLMOD
  EXPECT_THROW(factor.compute(lower(indefinite), {}), SolverError);
#endif
  factor.compute(lower(A), {});
  const Eigen::MatrixXd B = random_values(A.rows(), 1, 3);
  EXPECT_LE((A * factor.solve(B) - B).norm(), kRounding * B.norm());
}

TEST(SparseCholesky, OneAfterTheOtherHasTheBitsOfOneAlone) {
  const Matrix A = positive_matrix(15, 12), of_other_places = positive_matrix(12, 15);
  Matrix larger = A;
  larger.coeffRef(20, 20) += 3;
  std::vector<char> fixed(A.rows(), 0);
  fixed[7] = 1;
  const Eigen::MatrixXd B = random_values(A.rows(), 2, 6);
  SparseCholesky one;
  for (const auto& [matrix, held] : std::vector<std::pair<Matrix, std::vector<char>>>{{A, {}},
                                                                                      {larger, {}},
                                                                                      {A, fixed},
                                                                                      {A, {}},
                                                                                      {of_other_places, {}},
                                                                                      {A, fixed},
                                                                                      {larger, fixed},
                                                                                      {larger, {}}}) {
    SparseCholesky alone;
    one.compute(lower(matrix), held);
    alone.compute(lower(matrix), held);
    EXPECT_TRUE(same_bits(one.solve(B), alone.solve(B)));
  }
}

TEST_P(FixedUnknowns, UnknownsThatNothingConnectsAreSolvedFor) {
  const int n = GetParam() + 2;
  Matrix A(n, n);
  A.setIdentity();
  std::vector<char> fixed(n, 0);
  fixed[n - 1] = 1;
  SparseCholesky factor;
  factor.compute(A, fixed);
  Eigen::MatrixXd B = random_values(n, 2, 5);
  EXPECT_TRUE(same_bits(factor.solve(B), B));
  B.row(n - 1).setZero();
  EXPECT_TRUE(same_bits(factor.solve_fixed(B), B));
  SparseCholesky alone;
  alone.compute(A.topLeftCorner(1, 1), {1});
  EXPECT_TRUE(same_bits(alone.solve(B.topRows(1)), B.topRows(1)));
}

TEST(SparseCholesky, NothingIsSolved) {
  SparseCholesky factor;
  factor.compute(Matrix(0, 0), {});
  EXPECT_EQ(factor.solve(Eigen::MatrixXd(0, 3)).cols(), 3);
}

TEST(SparseCholesky, SeveralAtOnceHaveTheBitsOfOneAlone) {
  const Matrix A = positive_matrix(60, 50);
  const Eigen::MatrixXd B = random_values(A.rows(), 4, 4);
  const auto solved = [&] {
    SparseCholesky factor;
    factor.compute(lower(A), {});
    return factor.solve(B);
  };
  const Eigen::MatrixXd alone = solved();
  std::vector<Eigen::MatrixXd> solutions(3);
  std::vector<std::thread> threads;
  for (Eigen::MatrixXd& solution : solutions) threads.emplace_back([&] { solution = solved(); });
  for (std::thread& thread : threads) thread.join();
  for (const Eigen::MatrixXd& solution : solutions) EXPECT_TRUE(same_bits(solution, alone));
}

#ifdef HOLOMORPH_WITH_OPENBLAS
TEST(SparseCholesky, TheNumberOfBlasThreadsIsPutBack) {
  const int before = openblas_get_num_threads();
  openblas_set_num_threads(2);
  const Matrix A = lower(positive_matrix(15, 12));
  std::vector<std::thread> threads;
  for (int thread = 0; thread < 3; ++thread) {
    threads.emplace_back([&A] {
      for (int i = 0; i < 50; ++i) SparseCholesky().compute(A, {});
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(openblas_get_num_threads(), 2);
  openblas_set_num_threads(before);
}
#endif

}  // namespace
}  // namespace holomorph::solver
