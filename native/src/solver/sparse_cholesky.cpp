#include "solver/sparse_cholesky.h"

#include "base/errors.h"

#ifdef HOLOMORPH_WITH_CHOLMOD
#include <Eigen/CholmodSupport>
#else
#include <Eigen/SparseCholesky>
#endif

#ifdef HOLOMORPH_WITH_OPENBLAS
extern "C" {
void openblas_set_num_threads(int);
int openblas_get_num_threads(void);
}
#endif

namespace holomorph::solver {
namespace {

using Lower = Eigen::SparseMatrix<double>;

// The number of BLAS threads belongs to the process; it is put back as it was.
class OneBlasThread {
 public:
#ifdef HOLOMORPH_WITH_OPENBLAS
  OneBlasThread() : before_(openblas_get_num_threads()) { openblas_set_num_threads(1); }
  ~OneBlasThread() { openblas_set_num_threads(before_); }

 private:
  int before_;
#else
  OneBlasThread() {}
#endif
};

void check(bool done, Eigen::Index unknowns) {
  if (done) return;
  throw SolverError("the factorisation of a system of " + std::to_string(unknowns) +
                    " unknowns failed: not positive definite, or out of memory");
}

}  // namespace

#ifdef HOLOMORPH_WITH_CHOLMOD

struct SparseCholesky::Factor {
  Factor() {
    cholmod_start(&common);
    common.print = 0;
    common.error_handler = nullptr;
    common.supernodal = CHOLMOD_SUPERNODAL;
    common.nmethods = 1;  // AMD alone: METIS is slower here up to 4M faces
    common.postorder = 1;
  }
  ~Factor() {
    cholmod_free_factor(&L, &common);
    cholmod_finish(&common);
  }
  Factor(const Factor&) = delete;
  Factor& operator=(const Factor&) = delete;

  void analyse(cholmod_sparse& A);
  Eigen::MatrixXd apply(int system, const Eigen::MatrixXd& B);

  cholmod_common common;
  cholmod_factor* L = nullptr;
  std::vector<char> held;
};

// Where unknowns are held, AMD with the constraint that they come last. The postordering that follows moves some of
// them forward again, but never before an unknown that depends on them: the ancestors of a held one are held.
void SparseCholesky::Factor::analyse(cholmod_sparse& A) {
  if (held.empty()) {
    common.method[0].ordering = CHOLMOD_AMD;
    L = cholmod_analyze(&A, &common);
    return;
  }
  common.method[0].ordering = CHOLMOD_GIVEN;
  std::vector<int> last(held.begin(), held.end()), order(held.size());
  if (cholmod_camd(&A, nullptr, 0, last.data(), order.data(), &common)) {
    L = cholmod_analyze_p(&A, order.data(), nullptr, 0, &common);
  }
}

// The solution of one of CHOLMOD's systems: A x = b, P' x = b, L x = b, L' x = b, P x = b.
Eigen::MatrixXd SparseCholesky::Factor::apply(int system, const Eigen::MatrixXd& B) {
  cholmod_dense b = Eigen::viewAsCholmod(const_cast<Eigen::MatrixXd&>(B));  // CHOLMOD only reads it
  cholmod_dense* x = cholmod_solve(system, L, &b, &common);
  check(x != nullptr, B.rows());
  const Eigen::MatrixXd X = Eigen::Map<Eigen::MatrixXd>(static_cast<double*>(x->x), B.rows(), B.cols());
  cholmod_free_dense(&x, &common);
  return X;
}

void SparseCholesky::compute(const Lower& lower, std::vector<char> held) {
  const OneBlasThread one_thread;
  factor_ = std::make_unique<Factor>();
  factor_->held = std::move(held);
  if (lower.rows() == 0) return;
  cholmod_sparse A = Eigen::viewAsCholmod(lower.selfadjointView<Eigen::Lower>());
  factor_->analyse(A);
  check(factor_->L != nullptr, lower.rows());
  cholmod_factorize(&A, factor_->L, &factor_->common);
  check(factor_->common.status == CHOLMOD_OK, lower.rows());
}

Eigen::MatrixXd SparseCholesky::solve(const Eigen::MatrixXd& B) {
  const OneBlasThread one_thread;
  return B.rows() == 0 ? B : factor_->apply(CHOLMOD_A, B);
}

// Forward and backward substitution; in between the held unknowns are set to 0. Forward they do not act on the others,
// as no other comes after them that depends on them; backward they are 0, as those that they depend on are held.
Eigen::MatrixXd SparseCholesky::solve_held(const Eigen::MatrixXd& B) {
  const OneBlasThread one_thread;
  if (B.rows() == 0) return B;
  Eigen::MatrixXd X = factor_->apply(CHOLMOD_L, factor_->apply(CHOLMOD_P, B));
  const int* const order = static_cast<const int*>(factor_->L->Perm);
  for (Eigen::Index i = 0; i < X.rows(); ++i) {
    if (factor_->held[order[i]]) X.row(i).setZero();
  }
  return factor_->apply(CHOLMOD_Pt, factor_->apply(CHOLMOD_Lt, X));
}

#else

struct SparseCholesky::Factor {
  using Method = Eigen::SimplicialLDLT<Lower, Eigen::Lower>;

  static void compute(Method& method, const Lower& lower) {
    if (lower.rows() == 0) return;
    method.compute(lower);
    check(method.info() == Eigen::Success, lower.rows());
  }

  Method whole, others;
  Lower lower_of_others;             // until `others` is asked for
  std::vector<Eigen::Index> places;  // of the others among all
  bool asked = false;
};

void SparseCholesky::compute(const Lower& lower, std::vector<char> held) {
  factor_ = std::make_unique<Factor>();
  Factor::compute(factor_->whole, lower);
  if (held.empty()) return;
  std::vector<Eigen::Index> number(held.size(), -1);
  for (std::size_t i = 0; i < held.size(); ++i) {
    if (held[i]) continue;
    number[i] = static_cast<Eigen::Index>(factor_->places.size());
    factor_->places.push_back(static_cast<Eigen::Index>(i));
  }
  const auto n = static_cast<Eigen::Index>(factor_->places.size());
  Lower& others = factor_->lower_of_others;
  others.resize(n, n);
  others.reserve(lower.nonZeros());
  for (Eigen::Index column = 0; column < n; ++column) {
    others.startVec(column);
    for (Lower::InnerIterator it(lower, factor_->places[column]); it; ++it) {
      if (number[it.row()] >= 0) others.insertBack(number[it.row()], column) = it.value();
    }
  }
  others.finalize();
}

Eigen::MatrixXd SparseCholesky::solve(const Eigen::MatrixXd& B) {
  if (B.rows() == 0) return B;
  return factor_->whole.solve(B);
}

Eigen::MatrixXd SparseCholesky::solve_held(const Eigen::MatrixXd& B) {
  Eigen::MatrixXd X = Eigen::MatrixXd::Zero(B.rows(), B.cols());
  if (factor_->places.empty()) return X;
  if (!factor_->asked) {
    Factor::compute(factor_->others, factor_->lower_of_others);
    factor_->lower_of_others = {};
    factor_->asked = true;
  }
  const Eigen::MatrixXd rows = B(factor_->places, Eigen::all);
  X(factor_->places, Eigen::all) = factor_->others.solve(rows);
  return X;
}

#endif

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
