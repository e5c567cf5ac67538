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

#ifdef HOLOMORPH_WITH_CHOLMOD
using Method = Eigen::CholmodSupernodalLLT<Eigen::SparseMatrix<double>, Eigen::Lower>;
#else
using Method = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower>;
#endif

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

}  // namespace

struct SparseCholesky::Factor {
  Method method;
};

SparseCholesky::SparseCholesky() : factor_(std::make_unique<Factor>()) {
#ifdef HOLOMORPH_WITH_CHOLMOD
  auto& common = factor_->method.cholmod();
  common.print = 0;
  common.error_handler = nullptr;
  common.nmethods = 1;  // AMD alone: METIS is slower here up to 4M faces
  common.method[0].ordering = CHOLMOD_AMD;
  common.postorder = 1;
#endif
}

SparseCholesky::~SparseCholesky() = default;

void SparseCholesky::compute(const Eigen::SparseMatrix<double>& lower) {
  const OneBlasThread one_thread;
  if (lower.rows() == 0) return;
  factor_->method.compute(lower);
  if (factor_->method.info() != Eigen::Success) {
    throw SolverError("the factorisation of a system of " + std::to_string(lower.rows()) +
                      " unknowns failed: not positive definite, or out of memory");
  }
}

Eigen::MatrixXd SparseCholesky::solve(const Eigen::MatrixXd& B) const {
  const OneBlasThread one_thread;
  if (B.rows() == 0) return B;
  return factor_->method.solve(B);
}

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
