#include "solver/direct/sparse_cholesky.h"

#include <algorithm>
#include <cmath>
#include <future>
#include <new>
#include <span>

#include "base/errors.h"
#include "base/execution.h"
#include "linear/blas.h"

#ifndef _WIN32
#include <unistd.h>
#endif

#ifdef HOLOMORPH_WITH_CHOLMOD
#include <Eigen/CholmodSupport>
#else
#include <Eigen/SparseCholesky>
#endif

namespace holomorph::solver {
namespace {

// Whether this process was made by fork after the library was loaded.
#ifndef _WIN32
const pid_t kLoadedIn = getpid();
bool is_forked() { return getpid() != kLoadedIn; }
#else
bool is_forked() { return false; }
#endif

// Calls work(), on a thread of its own in a process made by fork. The calling thread may remember OpenMP threads of an
// earlier factorisation, which only the parent has. It would wait for them for ever.
template <class Work>
auto on_sound_thread(const Work& work) {
  return is_forked() ? std::async(std::launch::async, work).get() : work();
}

using Lower = Eigen::SparseMatrix<double>;

// What Execution counts for each entry of the matrix.
constexpr double kOrdering = 80;

void check(bool done, Eigen::Index unknowns) {
  if (done) return;
  throw SolverError("the factorisation of a system of " + std::to_string(unknowns) +
                    " unknowns failed: not positive definite");
}

// The rows and columns of `places`, ascending.
Lower part(const Lower& lower, const std::vector<Eigen::Index>& places) {
  std::vector<Eigen::Index> number(lower.rows(), -1);
  for (std::size_t i = 0; i < places.size(); ++i) number[places[i]] = static_cast<Eigen::Index>(i);
  const auto n = static_cast<Eigen::Index>(places.size());
  Lower result(n, n);
  result.reserve(lower.nonZeros());
  for (Eigen::Index column = 0; column < n; ++column) {
    result.startVec(column);
    for (Lower::InnerIterator it(lower, places[column]); it; ++it) {
      if (number[it.row()] >= 0) result.insertBack(number[it.row()], column) = it.value();
    }
  }
  result.finalize();
  return result;
}

}  // namespace

#ifdef HOLOMORPH_WITH_CHOLMOD

// Fixed unknowns become a dense block at the end of the factor where what is left of the surface connects them. Beyond
// this many times n^1.5 operations two factorisations are faster than that one; AMD's own order takes 3 to 50.
constexpr double kMostOperations = 300;
constexpr double kFlops = 4;  // floating-point operations in one of those that Execution counts

struct Dense {
  Dense(std::size_t rows, std::size_t columns, cholmod_common& common)
      : matrix(cholmod_allocate_dense(rows, columns, rows, CHOLMOD_REAL, &common)), common(common) {
    if (matrix == nullptr) throw std::bad_alloc();
  }
  ~Dense() { cholmod_free_dense(&matrix, &common); }
  Dense(const Dense&) = delete;
  Dense& operator=(const Dense&) = delete;

  cholmod_dense* matrix;
  cholmod_common& common;
};

struct SparseCholesky::Factor {
  Factor() {
    cholmod_start(&common);
    common.print = 0;
    common.error_handler = nullptr;
    common.supernodal = CHOLMOD_SUPERNODAL;
    common.nmethods = 1;  // AMD alone: METIS is slower here up to 4M faces
    common.method[0].ordering = CHOLMOD_AMD;
    common.postorder = 1;
  }
  ~Factor() {
    cholmod_free_factor(&L, &common);
    cholmod_finish(&common);
  }
  Factor(const Factor&) = delete;
  Factor& operator=(const Factor&) = delete;

  void compute(const Lower& lower) {
    cholmod_sparse A = Eigen::viewAsCholmod(lower.selfadjointView<Eigen::Lower>());
    if (!has_entries_of(lower)) {
      cholmod_free_factor(&L, &common);
      L = cholmod_analyze(&A, &common);
      rows.assign(lower.innerIndexPtr(), lower.innerIndexPtr() + lower.nonZeros());
      starts.assign(lower.outerIndexPtr(), lower.outerIndexPtr() + lower.cols() + 1);
    }
    factorise(A);
  }

  // Whether the last matrix had its entries in the same places: then the order of elimination is the same.
  bool has_entries_of(const Lower& lower) const {
    return L != nullptr && std::ranges::equal(starts, std::span(lower.outerIndexPtr(), lower.cols() + 1)) &&
           std::ranges::equal(rows, std::span(lower.innerIndexPtr(), lower.nonZeros()));
  }

  // AMD with the constraint that the fixed unknowns come last. The postordering that follows moves some of them forward
  // again, but never before an unknown that depends on them: the ancestors of a fixed one are fixed.
  // @return false where that would be slow, and where no two unknowns are connected: CAMD 2.4 then reads beyond its
  // arrays
  bool compute_fixed_last(const Lower& lower, const std::vector<char>& fixed) {
    if (lower.nonZeros() == lower.rows()) return false;
    cholmod_sparse A = Eigen::viewAsCholmod(lower.selfadjointView<Eigen::Lower>());
    std::vector<int> last(fixed.begin(), fixed.end()), order(fixed.size());
    common.method[0].ordering = CHOLMOD_GIVEN;
    if (cholmod_camd(&A, nullptr, 0, last.data(), order.data(), &common)) {
      L = cholmod_analyze_p(&A, order.data(), nullptr, 0, &common);
    }
    check_memory();
    if (L == nullptr || common.fl > kMostOperations * std::pow(static_cast<double>(lower.rows()), 1.5)) return false;
    factorise(A);
    return true;
  }

  Eigen::MatrixXd solve(const Eigen::MatrixXd& B) { return apply(CHOLMOD_A, B); }

  // What Execution counts for the factor.
  double operations() const { return kOrdering * common.anz + common.fl / kFlops; }
  double entries() const { return common.lnz; }

  // Forward and backward substitution; in between the fixed unknowns are set to 0. Forward they do not act on the
  // others, none of which depends on them; backward they stay 0, as those that they depend on are fixed.
  Eigen::MatrixXd solve_fixed(const Eigen::MatrixXd& B, const std::vector<char>& fixed) {
    Eigen::MatrixXd X = apply(CHOLMOD_L, apply(CHOLMOD_P, B));
    const int* const order = static_cast<const int*>(L->Perm);
    for (Eigen::Index i = 0; i < X.rows(); ++i) {
      if (fixed[order[i]]) X.row(i).setZero();
    }
    return apply(CHOLMOD_Pt, apply(CHOLMOD_Lt, X));
  }

 private:
  void factorise(cholmod_sparse& A) {
    const auto unknowns = static_cast<Eigen::Index>(A.nrow);
    check_memory();
    check(L != nullptr, unknowns);
    cholmod_factorize(&A, L, &common);
    check_memory();
    check(common.status == CHOLMOD_OK, unknowns);
  }

  // The solution of one of CHOLMOD's systems: A x = b, L x = b, L' x = b, and permutations.
  Eigen::MatrixXd apply(int system, const Eigen::MatrixXd& B) {
    cholmod_dense b = Eigen::viewAsCholmod(const_cast<Eigen::MatrixXd&>(B));  // CHOLMOD only reads it
    // The workspace too: CHOLMOD 3 looks at only one of its two parts, whether it got the memory.
    Dense x(b.nrow, b.ncol, common), y(b.nrow, b.ncol, common), e(b.ncol, L->maxesize, common);
    check(cholmod_solve2(system, L, &b, nullptr, &x.matrix, nullptr, &y.matrix, &e.matrix, &common) != 0, B.rows());
    return Eigen::Map<Eigen::MatrixXd>(static_cast<double*>(x.matrix->x), B.rows(), B.cols());
  }

  // Memory that CHOLMOD did not get is no reason to go another way.
  void check_memory() const {
    if (common.status == CHOLMOD_OUT_OF_MEMORY) throw std::bad_alloc();
  }

  cholmod_common common;
  cholmod_factor* L = nullptr;
  std::vector<int> starts, rows;  // of the last matrix
};

#else

struct SparseCholesky::Factor {
  void compute(const Lower& lower) {
    method.compute(lower);
    check(method.info() == Eigen::Success, lower.rows());
  }
  bool compute_fixed_last(const Lower&, const std::vector<char>&) { return false; }
  Eigen::MatrixXd solve(const Eigen::MatrixXd& B) { return method.solve(B); }
  Eigen::MatrixXd solve_fixed(const Eigen::MatrixXd& B, const std::vector<char>&) { return solve(B); }
  double operations() const { return kOrdering * entries(); }
  double entries() const { return static_cast<double>(method.matrixL().nestedExpression().nonZeros()); }

  Eigen::SimplicialLDLT<Lower, Eigen::Lower> method;
};

#endif

void SparseCholesky::compute(const Lower& lower, std::vector<char> fixed) {
  const linear::OneBlasThread one_thread;
  const bool is_plain = fixed_.empty() && fixed.empty();  // else the order of elimination is another one
  fixed_ = std::move(fixed);
  others_.clear();
  factor_of_others_.reset();
  if (!factor_ || !is_plain) factor_ = std::make_unique<Factor>();
  if (lower.rows() == 0) return;
  on_sound_thread([&] { factorise(lower); });
  Execution::count(factor_->operations() +
                   (factor_of_others_ && !others_.empty() ? factor_of_others_->operations() : 0));
}

void SparseCholesky::factorise(const Lower& lower) {
  if (fixed_.empty()) {
    factor_->compute(lower);
    // One factor serves both conditions if the fixed unknowns can come last at a fair price. Otherwise there are two:
    // of all unknowns, and of the free ones.
  } else if (!factor_->compute_fixed_last(lower, fixed_)) {
    factor_ = std::make_unique<Factor>();
    factor_->compute(lower);
    for (std::size_t i = 0; i < fixed_.size(); ++i) {
      if (fixed_[i] == 0) others_.push_back(static_cast<Eigen::Index>(i));
    }
    factor_of_others_ = std::make_unique<Factor>();
    if (!others_.empty()) factor_of_others_->compute(part(lower, others_));
  }
}

Eigen::MatrixXd SparseCholesky::solve(const Eigen::MatrixXd& B) {
  const linear::OneBlasThread one_thread;
  count_solution(B);
  return B.rows() == 0 ? B : on_sound_thread([&] { return factor_->solve(B); });
}

Eigen::MatrixXd SparseCholesky::solve_fixed(const Eigen::MatrixXd& B) {
  const linear::OneBlasThread one_thread;
  count_solution(B);
  if (B.rows() == 0) return B;
  if (!factor_of_others_) return on_sound_thread([&] { return factor_->solve_fixed(B, fixed_); });
  Eigen::MatrixXd X = Eigen::MatrixXd::Zero(B.rows(), B.cols());
  if (!others_.empty())
    X(others_, Eigen::all) = on_sound_thread([&] { return factor_of_others_->solve(B(others_, Eigen::all)); });
  return X;
}

// Each entry of the factor is read twice.
void SparseCholesky::count_solution(const Eigen::MatrixXd& B) const {
  if (B.rows() > 0) Execution::count(2 * factor_->entries() * static_cast<double>(B.cols()));
}

SparseCholesky::SparseCholesky() = default;
SparseCholesky::~SparseCholesky() = default;

bool SparseCholesky::supernodal() {
#ifdef HOLOMORPH_WITH_CHOLMOD
  return true;
#else
  return false;
#endif
}

std::string SparseCholesky::name() {
#ifdef HOLOMORPH_WITH_CHOLMOD
#ifdef HOLOMORPH_WITH_OPENBLAS
  return "CHOLMOD supernodal with OpenBLAS, AMD ordering";
#else
  return "CHOLMOD supernodal, AMD ordering";
#endif
#else
  return "Eigen simplicial LDLT, AMD ordering";
#endif
}

}  // namespace holomorph::solver
