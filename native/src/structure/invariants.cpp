#include "structure/invariants.h"

#include <utility>

#include "forms/gram_matrices.h"
#include "structure/guarantee.h"

namespace holomorph::structure {
namespace {

// W measured on one combination of the Dirichlet forms, with coefficients 1 and -1 in turn: cost #T n instead of #T
// n^2.
double largest_pairing_error(const mesh::HalfEdges& mesh, const forms::ClosedForms& forms, const Topology& topology,
                             Execution& execution) {
  const auto n = topology.pairing.rows();
  if (topology.families.dirichlet == 0) return 0;
  Eigen::VectorXd signs = Eigen::VectorXd::Ones(n);
  for (Eigen::Index j = 1; j < n; j += 2) signs[j] = -1;
  Eigen::VectorXd c = Eigen::VectorXd::Zero(2 * n);
  c.tail(n) = signs;
  const Eigen::VectorXd products = forms::wedges(mesh, forms, forms::combination(mesh, forms, c), execution);
  return (products.head(n) - topology.pairing.cast<double>() * signs).cwiseAbs().maxCoeff();
}

}  // namespace

CertainGram certain_energies(const mesh::HalfEdges& triangulation, std::span<const double> weights,
                             std::span<const double> errors, const forms::ClosedForms& forms,
                             const std::vector<int>& families, Execution& execution) {
  CertainGram result;
  std::vector<Eigen::MatrixXd> uncertain;
  for (const auto& gram : forms::gram_matrices(triangulation, weights, errors, forms, families, execution)) {
    result.gram.push_back(gram.value);
    if (!errors.empty()) uncertain.push_back(forms::gram_errors(gram));
  }
  result.certain = certain_gram(result.gram, uncertain);
  return result;
}

void complete(const mesh::HalfEdges& triangulation, std::span<const double> weights, std::span<const double> errors,
              const topology::IntegerForms& classes, Structure& result, Execution& execution) {
  const Topology& topology = result.topology;
  const Families& families = topology.families;
  forms::ClosedForms forms{classes, {}};
  forms.functions.swap(result.functions);
  std::vector<int> sizes{families.natural};
  if (families.dirichlet > 0) sizes.push_back(families.dirichlet);
  execution.part(0, 0.3);
  // Admissible are functions that are 0 there exactly.
  const auto fixed = mesh::boundary_vertices(topology.boundary);
  forms.functions(fixed, Eigen::lastN(families.dirichlet)).setZero();
  auto energies = certain_energies(triangulation, weights, errors, forms, sizes, execution);
  result.gram = std::move(energies.gram);
  result.certain_gram = std::move(energies.certain);
  execution.part(0.3, 1);
  result.certificate.residuals = forms::residuals(triangulation, weights, forms, execution, families.natural, fixed);
  result.certificate.pairing = largest_pairing_error(triangulation, forms, topology, execution);
  // The loops run along edges of the surface itself, and so do its classes; the functions are the same.
  add_loop_indicators(topology, forms.functions);
  forms.classes = topology.classes;
  result.certificate.periods = forms::period_residual(*result.surface, forms, topology.homology_basis);
  result.functions.swap(forms.functions);
  set_holomorphic_basis(result);
}

void set_holomorphic_basis(Structure& result) {
  const Topology& topology = result.topology;
  result.holomorphic =
      topology.families.dirichlet > 0
          ? conformal::bounded_basis(result.gram, result.certain_gram, topology.pairing, topology.type.genus)
          : conformal::closed_basis(result.gram[0], result.certain_gram[0], topology.pairing, topology.canonical);
  result.differentials = result.holomorphic.differentials;
}

}  // namespace holomorph::structure
