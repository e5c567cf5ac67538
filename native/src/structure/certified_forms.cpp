#include "structure/certified_forms.h"

#include <sstream>
#include <utility>

#include "base/errors.h"
#include "linear/dense.h"

namespace holomorph::structure {

using Eigen::MatrixXd;

namespace {

// Checks the pairing W on one combination of the Dirichlet forms, with coefficients 1 and -1 in turn. This costs #T n
// operations instead of #T n^2.
double largest_pairing_error(const mesh::HalfEdges& half_edges, const forms::ClosedForms& forms,
                             const Topology& topology, Execution& execution) {
  const auto n = topology.pairing.rows();
  if (topology.families.dirichlet == 0) return 0;
  Eigen::VectorXd signs = Eigen::VectorXd::Ones(n);
  for (Eigen::Index j = 1; j < n; j += 2) signs[j] = -1;
  Eigen::VectorXd c = Eigen::VectorXd::Zero(2 * n);
  c.tail(n) = signs;
  const Eigen::VectorXd products =
      forms::wedges(half_edges, forms, forms::combination(half_edges, forms, c), execution);
  return (products.head(n) - topology.pairing.cast<double>() * signs).cwiseAbs().maxCoeff();
}

std::vector<int> sizes(const Families& families) {
  std::vector<int> result{families.natural};
  if (families.dirichlet > 0) result.push_back(families.dirichlet);
  return result;
}

}  // namespace

void refuse(const std::string& what, double size, double allowed) {
  std::ostringstream message;
  message << what << " " << size << ", more than " << allowed << ": triangles are too thin for double precision";
  throw SolverError(message.str());
}

CertainGram certain_gram(std::vector<MatrixXd> gram, const std::vector<MatrixXd>& errors) {
  std::vector<MatrixXd> certain = gram;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    // The largest x E x / x G x: the relative change by rounding of the energy of any combination of forms.
    if (!linear::is_below(errors[i], kMostUncertain * gram[i])) {
      const double most = linear::greatest_quotient(errors[i], gram[i]).value_or(1);
      refuse("rounding may change the energies of harmonic forms by", most, kMostUncertain);
    }
    certain[i] += errors[i];
  }
  return {std::move(gram), std::move(certain)};
}

CertainGram certain_energies(const std::vector<forms::GramMatrix>& measured) {
  std::vector<MatrixXd> gram, errors;
  for (const forms::GramMatrix& one : measured) {
    gram.push_back(one.value);
    // Without errors of the weights none are wanted.
    if (one.cut_size.size() > 0) errors.push_back(forms::gram_errors(one));
  }
  return certain_gram(std::move(gram), errors);
}

CertainGram certain_energies(const mesh::Discretisation& discretisation, const forms::ClosedForms& forms,
                             const std::vector<int>& families, Execution& execution) {
  const auto& [half_edges, lengths, weights, errors, metric_error, mollification, flips] = discretisation;
  return certain_energies(forms::gram_matrices(half_edges, weights, errors, forms, families, execution));
}

void require_ordered(const MatrixXd& lower, const MatrixXd& upper, double allowed) {
  if (lower.size() == 0) return;
  if (!lower.allFinite() || !upper.allFinite())
    throw SolverError("the bounds of the conformal invariants are not finite");
  MatrixXd allowed_lower = lower;
  allowed_lower.diagonal().array() -= allowed * upper.norm();
  if (linear::is_below(allowed_lower, upper)) return;
  // lower <= upper if and only if the difference has no negative eigenvalue. The most negative one tells by how much
  // they cross.
  const double crossing = -linear::eigenvalues(upper - lower).minCoeff() / upper.norm();
  if (!(crossing <= allowed)) refuse("the bounds of the conformal invariants cross by", crossing, allowed);
}

Invariants invariants(const Topology& topology, CertainGram energies, Execution& execution) {
  const auto& [gram, certain] = energies;
  auto holomorphic = topology.families.dirichlet > 0
                         ? forms::bounded_basis(gram, certain, topology.pairing, topology.type.genus, execution)
                         : forms::closed_basis(gram[0], certain[0], topology.pairing, topology.canonical, execution);
  return {std::move(energies), std::move(holomorphic)};
}

HarmonicForms measured(const mesh::Surface& surface, const Topology& topology,
                       const mesh::Discretisation& discretisation, const topology::IntegerForms& classes,
                       forms::RowMajorMatrix functions, Execution& execution) {
  const auto& [natural, dirichlet, poles] = topology.families;
  const auto fixed = mesh::boundary_vertices(topology.boundary);
  // Bounds need admissible functions: 0 along the boundary exactly, and not to solver accuracy.
  functions(fixed, Eigen::lastN(dirichlet)).setZero();
  const forms::ClosedForms forms{classes, functions};
  execution.part(0, 0.3);
  auto energies = certain_energies(discretisation, forms, sizes(topology.families), execution);
  execution.part(0.3, 0.6);
  HarmonicForms result;
  Certificate& certificate = result.certificate;
  certificate.metric = discretisation.metric_error;
  certificate.residuals =
      forms::residuals(discretisation.half_edges, discretisation.weights, forms, execution, natural, fixed);
  certificate.pairing = largest_pairing_error(discretisation.half_edges, forms, topology, execution);
  // Loops and classes belong to the surface's own edges; functions at the vertices serve any triangulation.
  add_loop_indicators(topology, functions);
  certificate.periods = forms::period_residual(surface, {topology.classes, functions}, topology.homology_basis);
  execution.part(0.6, 1);
  result.invariants = invariants(topology, std::move(energies), execution);
  result.functions = std::make_shared<const forms::RowMajorMatrix>(std::move(functions));
  return result;
}

}  // namespace holomorph::structure
