#include "structure/certified_forms.h"

#include <algorithm>
#include <cassert>
#include <sstream>
#include <utility>

#include "base/errors.h"
#include "linear/dense.h"
#include "topology/fundamental_domain.h"

namespace holomorph::structure {

using Eigen::MatrixXd;

namespace {

using mesh::HalfedgeHandle;
using topology::FundamentalDomain;
using topology::IntegerForms;

// First the handles, then the boundary loops 1 .. b-1 with the hole on the left.
void set_loops(topology::DualBases& bases, Topology& result) {
  result.boundary = std::move(bases.boundary);
  result.homology_basis = std::move(bases.loops);
  const auto& loops = result.boundary.loops;
  if (loops.size() > 1) result.homology_basis.insert(result.homology_basis.end(), loops.begin() + 1, loops.end());
}

void set_pairing(const mesh::HalfEdges& half_edges, const IntegerForms& natural, Topology& result,
                 Execution& execution) {
  if (result.type.closed()) {
    result.pairing = topology::wedge_matrix(half_edges, natural, execution);
    if (result.type.genus > 0) result.canonical = topology::canonical_basis(result.pairing);
    return;
  }
  const auto relative = topology::relative_classes(half_edges, result.boundary, natural);
  result.pairing = topology::pairing(half_edges, natural, relative);
  [[maybe_unused]] const auto handles = 2 * result.type.genus,
                              loops = static_cast<int>(result.pairing.rows()) - handles;
  // W = [[J_h, 0], [X, 1]] (docs/method/boundaries.md).
  assert(result.pairing.topRightCorner(handles, loops).isZero());
  assert(result.pairing.bottomRightCorner(loops, loops).isIdentity());
}

// The classes of the whole basis. Harmonic measures of loops and the v of poles are functions, of class 0.
IntegerForms all_classes(const mesh::HalfEdges& half_edges, const FundamentalDomain& domain, IntegerForms natural,
                         const std::vector<mesh::Star>& stars, Topology& result) {
  const int handles = 2 * result.type.genus;
  Families& families = result.families;
  families.natural = natural.form_count;
  families.dirichlet = result.type.closed() ? 0 : natural.form_count;
  if (families.dirichlet > 0)
    // The Dirichlet family: the classes of the handles again, then zero classes for the harmonic measures of the loops.
    natural = topology::concatenated(natural, topology::first_forms(natural, handles, families.dirichlet));
  if (stars.empty()) return natural;
  const auto poles = topology::pole_classes(half_edges, domain, stars);
  families.poles = poles.form_count;
  return topology::concatenated(natural, topology::first_forms(poles, families.poles, 2 * families.poles));
}

void add_spokes(const mesh::HalfEdges& half_edges, const std::vector<mesh::Star>& stars, std::vector<int>& seams) {
  for (const mesh::Star& star : stars) {
    // At a pole every triangle has an apex of its own: all spokes are seams.
    for (const HalfedgeHandle h : star.link) seams.push_back(mesh::edge_of(mesh::next(half_edges, h)));
  }
  std::sort(seams.begin(), seams.end());
  seams.erase(std::unique(seams.begin(), seams.end()), seams.end());
}

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

Topology find_topology(const mesh::Surface& surface, const mesh::HalfEdges& half_edges, Execution& execution,
                       std::optional<topology::DualBases> given, const std::vector<mesh::Star>& stars) {
  execution.part(0, 0.8);
  const auto domain = topology::fundamental_domain(surface, half_edges, execution, stars);
  execution.part(0.8, 1);
  Topology result;
  result.type = mesh::topological_type(surface);
  // By default the bases are found here; otherwise they were lifted from a coarser mesh, and only the cut is new.
  if (!given)
    given = {topology::homology_basis(half_edges, domain), topology::natural_classes(half_edges, domain),
             domain.boundary};
  set_loops(*given, result);
  std::vector<int> poles;
  for (const mesh::Star& star : stars) poles.push_back(star.vertex);
  result.seams = topology::cut_graph(half_edges, domain, poles);
  add_spokes(half_edges, stars, result.seams);
  set_pairing(half_edges, given->classes, result, execution);
  result.classes = all_classes(half_edges, domain, std::move(given->classes), stars, result);
  result.sheets = uv::corner_sheets(surface, half_edges, domain, result.classes, execution);
  return result;
}

IntegerForms classes_on(const Topology& topology, const mesh::HalfEdges& half_edges,
                        const std::vector<mesh::Flip>& flips) {
  const Families& families = topology.families;
  auto natural = topology::first_forms(topology.classes, families.natural, families.natural);
  topology::pull_back(flips, natural);
  if (families.dirichlet == 0) return natural;
  return topology::concatenated(natural, topology::relative_classes(half_edges, topology.boundary, natural));
}

void add_loop_indicators(const Topology& topology, Eigen::Ref<forms::RowMajorMatrix> functions) {
  if (topology.families.dirichlet == 0) return;
  const int first = topology.families.natural + 2 * topology.type.genus;
  const auto& loop = topology.boundary.loop_of_vertex;
  for (int v = 0; v < static_cast<int>(loop.size()); ++v) {
    // The harmonic measure of loop k is 1 on that loop. Loop 0 has none: the sum of all is 1.
    if (loop[v] > 0) functions(v, first + loop[v] - 1) += 1;
  }
}

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
