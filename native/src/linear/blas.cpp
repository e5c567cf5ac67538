#include "linear/blas.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cassert>
#include <cstdlib>
#include <mutex>
#include <new>
#include <vector>

#ifdef HOLOMORPH_WITH_OPENBLAS
extern "C" {
// The OpenMP that CHOLMOD was built with has these; null where that was none.
__attribute__((weak)) int omp_get_max_active_levels(void);
__attribute__((weak)) void omp_set_max_active_levels(int);
void openblas_set_num_threads(int);
int openblas_get_num_threads(void);
void dgemm_(const char* of_a, const char* of_b, const int* m, const int* n, const int* k, const double* alpha,
            const double* a, const int* lda, const double* b, const int* ldb, const double* beta, double* c,
            const int* ldc);
void dgemv_(const char* of_a, const int* m, const int* n, const double* alpha, const double* a, const int* lda,
            const double* x, const int* step_x, const double* beta, double* y, const int* step_y);
void dtrsm_(const char* side, const char* triangle, const char* of_a, const char* diagonal, const int* m, const int* n,
            const double* alpha, const double* a, const int* lda, double* b, const int* ldb);
void dpotrf_(const char* triangle, const int* n, double* matrix, const int* stride, int* info);
void dgesv_(const int* n, const int* count, double* a, const int* lda, int* pivots, double* b, const int* ldb,
            int* info);
void dsyevd_(const char* job, const char* triangle, const int* n, double* a, const int* lda, double* w, double* work,
             const int* size, int* integers, const int* integer_count, int* info);
}
#endif

namespace holomorph::linear {

using Eigen::MatrixXd;
using Eigen::VectorXd;

#ifdef HOLOMORPH_WITH_OPENBLAS

namespace {

// OpenBLAS's workspace of a call, in bytes: 128 MiB and what malloc adds. It is kept for later calls.
constexpr std::size_t kWorkspace = std::size_t{130} << 20;
// What malloc of two other threads may take between the question and the call: 128 MiB each for an arena of their own.
constexpr std::size_t kArenas = std::size_t{256} << 20;

std::mutex mutex;
int users = 0, workspaces = 0, before = 1;

// OpenBLAS asks for its workspace again and again, without end, where there is no memory: so it is asked for here
// first. The first one is then taken at once, before anything else takes the memory.
// @throws std::bad_alloc
void take_workspace() {
  void* const found = std::malloc(kWorkspace + kArenas);
  if (found == nullptr) throw std::bad_alloc();
  std::free(found);
  if (workspaces++ > 0) return;
  const int n = 1;
  int info = 0;
  double one = 1;
  dpotrf_("L", &n, &one, &n, &info);
}

}  // namespace

OneBlasThread::OneBlasThread() {
  const std::lock_guard lock(mutex);
  if (users == workspaces) take_workspace();
  if (omp_set_max_active_levels) {
    levels_ = omp_get_max_active_levels();
    omp_set_max_active_levels(0);
  }
  if (users++ > 0) return;
  before = openblas_get_num_threads();
  openblas_set_num_threads(1);
}

OneBlasThread::~OneBlasThread() {
  if (omp_set_max_active_levels) omp_set_max_active_levels(levels_);
  const std::lock_guard lock(mutex);
  if (--users == 0) openblas_set_num_threads(before);
}

#else

OneBlasThread::OneBlasThread() {}
OneBlasThread::~OneBlasThread() {}

#endif

namespace {

// Part of the entries from which on zeros are not worth skipping.
constexpr double kFew = 0.1;
// Rows that stay in the cache while several columns are multiplied.
constexpr Eigen::Index kRows = 512;

#ifdef HOLOMORPH_WITH_OPENBLAS

bool is_small(Eigen::Index n, Eigen::Index most = kSmall) { return n <= most; }
int as_int(Eigen::Index n) { return static_cast<int>(n); }

void multiply(char of_b, const Block& A, const Block& B, double beta, Eigen::Ref<MatrixXd, 0, Eigen::OuterStride<>> C) {
  const OneBlasThread one_thread;
  const int m = as_int(C.rows()), n = as_int(C.cols()), k = as_int(A.cols()), lda = as_int(A.outerStride()),
            ldb = as_int(B.outerStride()), ldc = as_int(C.outerStride());
  const double one = 1;
  dgemm_("N", &of_b, &m, &n, &k, &one, A.data(), &lda, B.data(), &ldb, &beta, C.data(), &ldc);
}

// Y_j += A^T X_j or A X_j on some rows of A, for each column.
void multiply_rows(char of_a, const MatrixXd& A, Eigen::Index begin, Eigen::Index rows, const MatrixXd& X,
                   MatrixXd& Y) {
  const OneBlasThread one_thread;
  const bool transposed = of_a == 'T';
  const int m = as_int(rows), n = as_int(A.cols()), lda = as_int(A.rows()), step = 1;
  const double one = 1;
  for (Eigen::Index j = 0; j < X.cols(); ++j) {
    const double* const x = X.col(j).data() + (transposed ? begin : 0);
    double* const y = Y.col(j).data() + (transposed ? 0 : begin);
    dgemv_(&of_a, &m, &n, &one, A.data() + begin, &lda, x, &step, &one, y, &step);
  }
}

void solve_triangular(char of_l, const MatrixXd& L, MatrixXd& B) {
  const OneBlasThread one_thread;
  const int m = as_int(B.rows()), n = as_int(B.cols());
  const double one = 1;
  dtrsm_("L", "L", &of_l, "N", &m, &n, &one, L.data(), &m, B.data(), &m);
}

bool factorise_large(MatrixXd& A) {
  const OneBlasThread one_thread;
  const int n = as_int(A.rows());
  int info = 0;
  dpotrf_("L", &n, A.data(), &n, &info);
  return info == 0;
}

bool solve_large(MatrixXd& A, MatrixXd& B) {
  const OneBlasThread one_thread;
  const int n = as_int(A.rows()), count = as_int(B.cols());
  std::vector<int> pivots(n);
  int info = 0;
  dgesv_(&n, &count, A.data(), &n, pivots.data(), B.data(), &n, &info);
  return info == 0;
}

bool decompose_large(MatrixXd& A, VectorXd& eigenvalues) {
  const OneBlasThread one_thread;
  const int n = as_int(A.rows()), size = 1 + 6 * n + 2 * n * n, integer_count = 3 + 5 * n;
  std::vector<double> work(size);
  std::vector<int> integers(integer_count);
  int info = 0;
  eigenvalues.resize(n);
  dsyevd_("V", "L", &n, A.data(), &n, eigenvalues.data(), work.data(), &size, integers.data(), &integer_count, &info);
  return info == 0;
}

#else

bool is_small(Eigen::Index, Eigen::Index = kSmall) { return true; }
void multiply(char, const Block&, const Block&, double, Eigen::Ref<MatrixXd, 0, Eigen::OuterStride<>>) {}
void multiply_rows(char, const MatrixXd&, Eigen::Index, Eigen::Index, const MatrixXd&, MatrixXd&) {}
void solve_triangular(char, const MatrixXd&, MatrixXd&) {}
bool factorise_large(MatrixXd&) { return false; }
bool solve_large(MatrixXd&, MatrixXd&) { return false; }
bool decompose_large(MatrixXd&, VectorXd&) { return false; }

#endif

}  // namespace

MatrixXd product(const Block& A, const Block& B) {
  if (A.rows() > kSmall && static_cast<double>((A.array() != 0).count()) < kFew * static_cast<double>(A.size()))
    return Eigen::SparseMatrix<double>(A.sparseView()) * B;
  if (is_small(A.rows())) return A * B;
  MatrixXd C(A.rows(), B.cols());
  multiply('N', A, B, 0, C);
  return C;
}

MatrixXd congruent(const MatrixXd& T, const MatrixXd& G) {
  return product(T, product(T, G).transpose().eval()).transpose();
}

void add_product_transposed(const Block& A, const Block& B, Eigen::Ref<MatrixXd, 0, Eigen::OuterStride<>> C) {
  if (is_small(A.rows())) {
    C.noalias() += A * B.transpose();
  } else {
    multiply('T', A, B, 1, C);
  }
}

MatrixXd thin_product(const MatrixXd& A, const MatrixXd& X) {
  if (is_small(A.rows())) return A * X;
  MatrixXd Y = MatrixXd::Zero(A.rows(), X.cols());
  for (Eigen::Index begin = 0; begin < A.rows(); begin += kRows)
    multiply_rows('N', A, begin, std::min(kRows, A.rows() - begin), X, Y);
  return Y;
}

MatrixXd thin_transposed_product(const MatrixXd& A, const MatrixXd& Y) {
  if (is_small(A.rows())) return A.transpose() * Y;
  MatrixXd X = MatrixXd::Zero(A.cols(), Y.cols());
  for (Eigen::Index begin = 0; begin < A.rows(); begin += kRows)
    multiply_rows('T', A, begin, std::min(kRows, A.rows() - begin), Y, X);
  return X;
}

bool factorise(MatrixXd& A) {
  if (!is_small(A.rows(), kSmallFactor)) return factorise_large(A);
  return Eigen::LLT<Eigen::Ref<MatrixXd>>(A).info() == Eigen::Success;
}

void solve_lower(const MatrixXd& L, MatrixXd& B) {
  if (!is_small(L.rows(), kSmallFactor)) return solve_triangular('N', L, B);
  L.triangularView<Eigen::Lower>().solveInPlace(B);
}

void solve_upper(const MatrixXd& L, MatrixXd& B) {
  if (!is_small(L.rows(), kSmallFactor)) return solve_triangular('T', L, B);
  L.transpose().triangularView<Eigen::Upper>().solveInPlace(B);
}

MatrixXd solve(MatrixXd A, MatrixXd B) {
  if (is_small(A.rows())) return A.partialPivLu().solve(B);
  [[maybe_unused]] const bool is_regular = solve_large(A, B);
  assert(is_regular);
  return B;
}

bool decompose(MatrixXd& A, VectorXd& eigenvalues) {
  if (!is_small(A.rows())) return decompose_large(A, eigenvalues);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> found(A);
  if (found.info() != Eigen::Success) return false;
  eigenvalues = found.eigenvalues();
  A = found.eigenvectors();
  return true;
}

}  // namespace holomorph::linear
