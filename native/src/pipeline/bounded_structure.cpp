#include "pipeline/bounded_structure.h"

#include <algorithm>
#include <cassert>

#include "base/errors.h"
#include "mesh/components.h"

namespace holomorph::pipeline {
namespace {

int checked_genus(const mesh::Surface& surface) {
  const int boundaries = mesh::boundary_count(surface);
  const int genus = mesh::genus(mesh::euler_characteristic(surface), boundaries);
  if (boundaries > 0 && 2 * genus + boundaries > 1) return genus;
  throw TopologyError("the surface has genus " + std::to_string(genus) + " and " + std::to_string(boundaries) +
                      " boundary loops; a boundary, and a handle or a second loop, are needed");
}

// First the handles, then the boundary loops 1 .. b-1 with the hole on the left.
auto all_loops(const mesh::HalfEdges& half_edges, const topology::FundamentalDomain& domain) {
  auto loops = topology::homology_basis(half_edges, domain);
  loops.insert(loops.end(), domain.boundary.loops.begin() + 1, domain.boundary.loops.end());
  return loops;
}

// W = [[J_h, 0], [X, 1]] in these bases.
topology::IntegerMatrix pairing(const mesh::HalfEdges& half_edges, const mesh::BoundaryLoops& boundary,
                                const topology::IntegerForms& natural, int handles) {
  auto relative = topology::first_forms(natural, handles, handles);
  topology::add_loop_indicators(half_edges, boundary, relative);
  const auto W = topology::pairing(half_edges, natural, relative);
  [[maybe_unused]] const auto loops = W.rows() - handles;
  assert(W.topRightCorner(handles, loops).isZero() && W.bottomRightCorner(loops, loops).isIdentity());
  return W;
}

double largest_period_error(const Eigen::MatrixXd& periods, Eigen::Index natural) {
  return (periods.leftCols(natural) - Eigen::MatrixXd::Identity(natural, natural)).cwiseAbs().maxCoeff();
}

// W measured on one combination of the Dirichlet forms, with coefficients 1 and -1 in turn: cost #T n instead of #T
// n^2.
double largest_pairing_error(const mesh::HalfEdges& half_edges, const BoundedForms& forms,
                             const topology::IntegerMatrix& W, Execution& execution) {
  Eigen::VectorXd c = Eigen::VectorXd::Ones(W.cols());
  for (Eigen::Index j = 1; j < c.size(); j += 2) c[j] = -1;
  const Eigen::VectorXd form = forms::combination(half_edges, forms.dirichlet, c);
  return (forms::wedges(half_edges, forms.natural, form, execution) - W.cast<double>() * c).cwiseAbs().maxCoeff();
}

forms::Residuals larger(const forms::Residuals& a, const forms::Residuals& b) {
  return {std::max(a.closedness, b.closedness), std::max(a.harmonicity, b.harmonicity)};
}

}  // namespace

BoundedStructure bounded_structure(const mesh::Surface& surface, const Options& options, Execution& execution) {
  BoundedStructure result;

  execution.stage("half-edges", 0.0, 0.05);
  const int genus = checked_genus(surface);
  auto half_edges = mesh::half_edges(surface, execution);

  execution.stage("homology", 0.05, 0.15);
  const auto domain = topology::fundamental_domain(surface, half_edges, execution);
  result.boundary = domain.boundary;
  result.homology_basis = all_loops(half_edges, domain);
  result.seams = topology::cut_graph(half_edges, domain);
  result.collapsed_triangles = mesh::triangles_on_one_loop(surface, result.boundary);

  execution.stage("cohomology", 0.15, 0.2);
  auto natural_classes = topology::cohomology_basis(half_edges, domain);
  topology::add_paths_between_loops(half_edges, domain, natural_classes);
  result.pairing = pairing(half_edges, result.boundary, natural_classes, 2 * genus);
  auto classes =
      topology::beside(natural_classes, topology::first_forms(natural_classes, 2 * genus, natural_classes.form_count));
  result.sheets = uv::corner_sheets(surface, half_edges, domain, classes, execution);

  execution.stage("intrinsic Delaunay", 0.2, 0.25);
  auto intrinsic = mesh::intrinsic_triangulation(surface, std::move(half_edges), execution.workers());
  mesh::make_delaunay(intrinsic, execution);
  topology::carry_through(intrinsic.flips, natural_classes);

  execution.stage("Laplacian", 0.25, 0.3);
  const auto weights = mesh::cotangent_weights(intrinsic, execution);
  intrinsic.forget_metric();
  auto laplacian = forms::laplacian(intrinsic.half_edges, weights, execution);

  execution.stage("harmonic forms", 0.3, 0.85);
  auto solved = bounded_forms(intrinsic.half_edges, weights, std::move(laplacian), natural_classes, result.boundary,
                              options, execution);
  result.solver = solved.solver;

  execution.stage("holomorphic forms", 0.85, 0.92);
  result.natural_gram = forms::gram_matrix(intrinsic.half_edges, weights, solved.natural, execution);
  result.dirichlet_gram = forms::gram_matrix(intrinsic.half_edges, weights, solved.dirichlet, execution);
  result.holomorphic = conformal::bounded_basis(result.natural_gram, result.dirichlet_gram, result.pairing, genus);

  execution.stage("certificates", 0.92, 1.0);
  result.residuals = larger(forms::residuals(intrinsic.half_edges, weights, solved.natural, execution),
                            forms::residuals(intrinsic.half_edges, weights, solved.dirichlet, execution,
                                             mesh::boundary_vertices(result.boundary)));
  result.harmonic = {std::move(classes), side_by_side(solved)};
  result.period_residual =
      largest_period_error(forms::periods(surface, result.harmonic, result.homology_basis), result.pairing.rows());
  result.pairing_residual = largest_pairing_error(intrinsic.half_edges, solved, result.pairing, execution);
  result.mollification = intrinsic.mollification;
  result.flip_count = static_cast<int>(intrinsic.flips.size());
  execution.finish();
  result.seconds = execution.seconds();
  return result;
}

}  // namespace holomorph::pipeline
