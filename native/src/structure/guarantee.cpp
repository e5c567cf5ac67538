#include "structure/guarantee.h"

#include "base/errors.h"

namespace holomorph::structure {
namespace {

// Bounds of streamed forms may cross by this many times the asymmetry of their Gram matrix, which shows the residuals
// of their linear systems (streamed_forms.h). Other forms have none.
constexpr double kOfAsymmetry = 10;

}  // namespace

void require_guaranteed(const Structure& s) {
  const double residual = s.record.solver.residual;
  if (!(residual <= forms::kEnergyError))
    refuse("the linear systems have a relative residual of", residual, forms::kEnergyError);
  const auto& [star, differentials, period_matrix, bounds] = s.holomorphic();
  if (!period_matrix.allFinite()) throw SolverError("the period matrix is not finite");
  const double allowed = kCertain + kOfAsymmetry * s.harmonic.certificate.asymmetry;
  // Bounds of a mollified surface belong to another metric, and are not promised.
  if (s.record.mollification == 0) require_ordered(bounds.lower, bounds.upper, allowed);
}

}  // namespace holomorph::structure
