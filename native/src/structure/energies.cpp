#include "structure/energies.h"

#include <Eigen/Eigenvalues>
#include <sstream>
#include <utility>

#include "base/errors.h"
#include "forms/gram_matrices.h"

namespace holomorph::structure {

using Eigen::MatrixXd;

void refuse(const std::string& what, double size, double allowed) {
  std::ostringstream message;
  message << what << " " << size << ", more than " << allowed << ": triangles are too thin for double precision";
  throw SolverError(message.str());
}

CertainGram certain_gram(std::vector<MatrixXd> gram, const std::vector<MatrixXd>& errors) {
  std::vector<MatrixXd> certain = gram;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    // The largest x E x / x G x: the relative change by rounding of the energy of any combination of forms.
    const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> parts(errors[i], gram[i], Eigen::EigenvaluesOnly);
    const double most = parts.info() == Eigen::Success ? parts.eigenvalues().maxCoeff() : 1;
    if (!(most <= kMostUncertain))
      refuse("rounding may change the energies of harmonic forms by", most, kMostUncertain);
    certain[i] += errors[i];
  }
  return {std::move(gram), std::move(certain)};
}

CertainGram certain_energies(const mesh::Discretisation& discretisation, const forms::ClosedForms& forms,
                             const std::vector<int>& families, Execution& execution) {
  const auto& errors = discretisation.errors;
  std::vector<MatrixXd> gram, uncertain;
  for (const auto& measured :
       forms::gram_matrices(discretisation.half_edges, discretisation.weights, errors, forms, families, execution)) {
    gram.push_back(measured.value);
    if (!errors.empty()) uncertain.push_back(forms::gram_errors(measured));
  }
  return certain_gram(std::move(gram), uncertain);
}

void require_ordered(const MatrixXd& lower, const MatrixXd& upper, double allowed) {
  if (lower.size() == 0) return;
  if (!lower.allFinite() || !upper.allFinite())
    throw SolverError("the bounds of the conformal invariants are not finite");
  // lower <= upper if and only if the difference has no negative eigenvalue. The most negative one tells by how much
  // they cross.
  const Eigen::SelfAdjointEigenSolver<MatrixXd> width(upper - lower, Eigen::EigenvaluesOnly);
  const double crossing = -width.eigenvalues().minCoeff() / upper.norm();
  if (!(crossing <= allowed)) refuse("the bounds of the conformal invariants cross by", crossing, allowed);
}

}  // namespace holomorph::structure
