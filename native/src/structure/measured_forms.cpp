#include "structure/measured_forms.h"

#include <utility>
#include <vector>

namespace holomorph::structure {
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
  execution.part(0.3, 1);
  HarmonicForms result;
  Certificate& certificate = result.certificate;
  certificate.metric = discretisation.metric_error;
  certificate.residuals =
      forms::residuals(discretisation.half_edges, discretisation.weights, forms, execution, natural, fixed);
  certificate.pairing = largest_pairing_error(discretisation.half_edges, forms, topology, execution);
  // Loops and classes belong to the surface's own edges; functions at the vertices serve any triangulation.
  add_loop_indicators(topology, functions);
  certificate.periods = forms::period_residual(surface, {topology.classes, functions}, topology.homology_basis);
  result.invariants = invariants(topology, std::move(energies));
  result.functions = std::make_shared<const forms::RowMajorMatrix>(std::move(functions));
  return result;
}

}  // namespace holomorph::structure
