#include "structure/guarantee.h"

#include <Eigen/Eigenvalues>
#include <sstream>

#include "base/errors.h"
#include "forms/refined_solver.h"

namespace holomorph::structure {
namespace {

// What is left of the residuals in the Gram matrix of streamed forms, in parts of its asymmetry.
constexpr double kOfAsymmetry = 10;

[[noreturn]] void refuse(const char* what, double size, double allowed) {
  std::ostringstream message;
  message << what << " " << size << ", more than " << allowed << ": triangles are too thin for double precision";
  throw SolverError(message.str());
}

}  // namespace

std::vector<Eigen::MatrixXd> certain_gram(const std::vector<Eigen::MatrixXd>& gram,
                                          const std::vector<Eigen::MatrixXd>& errors) {
  std::vector<Eigen::MatrixXd> result = gram;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> parts(errors[i], gram[i], Eigen::EigenvaluesOnly);
    const double most = parts.info() == Eigen::Success ? parts.eigenvalues().maxCoeff() : 1;
    if (!(most <= kMostUncertain))
      refuse("rounding may change the energies of harmonic forms by", most, kMostUncertain);
    result[i] += errors[i];
  }
  return result;
}

void require_ordered(const Eigen::MatrixXd& lower, const Eigen::MatrixXd& upper, double allowed) {
  if (lower.size() == 0) return;
  if (!lower.allFinite() || !upper.allFinite())
    throw SolverError("the bounds of the conformal invariants are not finite");
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> width(upper - lower, Eigen::EigenvaluesOnly);
  const double crossing = -width.eigenvalues().minCoeff() / upper.norm();
  if (!(crossing <= allowed)) refuse("the bounds of the conformal invariants cross by", crossing, allowed);
}

void require_guaranteed(const Structure& s) {
  const double residual = s.solver.residual;
  if (!(residual <= forms::kEnergyError))
    refuse("the linear systems have a relative residual of", residual, forms::kEnergyError);
  if (!s.holomorphic.period_matrix.allFinite()) throw SolverError("the period matrix is not finite");
  const double allowed = kCertain + kOfAsymmetry * s.certificate.asymmetry;
  if (s.mollification == 0) require_ordered(s.holomorphic.bounds.lower, s.holomorphic.bounds.upper, allowed);
}

}  // namespace holomorph::structure
