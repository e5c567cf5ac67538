#include "structure/structure.h"

#include <algorithm>

#include "base/errors.h"
#include "forms/closed_forms.h"
#include "forms/gram_matrices.h"
#include "uv/uv_map.h"
#include "uv/zeros.h"

namespace holomorph::structure {
namespace {

// Harmonic forms that are never in memory all at once.

// Solves for the harmonic forms of a closed surface, as many at a time as the plan says, measures each block and drops
// it. The result has the Gram matrix, computed from <eta_i, h_j>, the certificate and the samples for the balanced
// map.
// @param classes on the discretisation of the solver
// Memory: that of the plan. @throws SolverError, Cancelled
HarmonicForms streamed_forms(const mesh::Surface& surface, const Topology& topology, HarmonicSolver& solver,
                             const topology::IntegerForms& classes, Execution& execution) {
  const auto& [half_edges, lengths, weights, errors, metric_error, mollification, flips] = solver.discretisation();
  const int n = classes.form_count, block = solver.plan().block, blocks = (n + block - 1) / block;
  HarmonicForms result;
  Certificate& certificate = result.certificate;
  certificate.metric = metric_error;
  Eigen::MatrixXd G(n, n);
  std::vector<Eigen::MatrixXd> uncertain;
  if (!errors.empty()) uncertain = {Eigen::MatrixXd::Zero(n, n)};
  const mesh::Sides side(surface);
  auto& [triangles, on_sides] = result.samples;
  triangles = uv::sample_triangles(surface);
  on_sides.resize(2 * static_cast<Eigen::Index>(triangles.size()), n);
  const auto measure = [&](int first, forms::RowMajorMatrix&& functions) {
    const auto width = functions.cols();
    const forms::ClosedForms solved{classes, functions, first}, on_surface{topology.classes, functions, first};
    // <h_i, h_j> = <eta_i, h_j>, since h_j is coclosed: no other form has to be there (docs/method/harmonic.md).
    G.middleCols(first, width) = forms::class_products(half_edges, weights, classes, solved);
    // A positive matrix is at most the number of its diagonal blocks times the matrix of these blocks alone.
    if (!errors.empty()) {
      uncertain[0].block(first, first, width, width) =
          blocks * forms::gram_matrices(half_edges, errors, {}, solved, {static_cast<int>(width)}, execution)[0].value;
    }
    const auto [closedness, harmonicity] =
        forms::residuals(half_edges, weights, solved, execution, static_cast<int>(width), {});
    certificate.residuals.closedness = std::max(certificate.residuals.closedness, closedness);
    certificate.residuals.harmonicity = std::max(certificate.residuals.harmonicity, harmonicity);
    certificate.periods =
        std::max(certificate.periods, forms::period_residual(surface, on_surface, topology.homology_basis));
    on_sides.middleCols(first, width) = uv::values_on_sides(surface, side, on_surface, triangles);
  };
  solver.solve_in_blocks(classes, n, execution, measure);
  // G is symmetric if the systems are solved exactly. The difference shows their residuals.
  certificate.asymmetry = (G - G.transpose()).cwiseAbs().maxCoeff() / G.cwiseAbs().maxCoeff();
  result.invariants = invariants(topology, certain_gram({(G + G.transpose()) / 2}, uncertain), execution);
  return result;
}

// Bounds of streamed forms may cross by this many times the asymmetry of their Gram matrix, which shows the residuals
// of their linear systems (certified_forms.h). Other forms have none.
constexpr double kOfAsymmetry = 10;

}  // namespace

HarmonicForms harmonic_forms(const mesh::Surface& surface, const Topology& topology, HarmonicSolver& solver,
                             Execution& execution) {
  const Execution::Within within(execution);
  execution.stage("harmonic forms", 0.0, 0.75);
  const auto& discretisation = solver.discretisation();
  const auto classes = classes_on(topology, discretisation.half_edges, discretisation.flips);
  if (!solver.plan().keep_forms) return streamed_forms(surface, topology, solver, classes, execution);
  auto functions = solver.solve(classes, topology.families.natural, execution);
  execution.stage("certificates", 0.75, 1.0);
  return measured(surface, topology, discretisation, classes, std::move(functions), execution);
}

forms::RowMajorMatrix harmonic_functions(const Topology& topology, HarmonicSolver& solver, Execution& execution) {
  const auto& discretisation = solver.discretisation();
  const auto classes = classes_on(topology, discretisation.half_edges, discretisation.flips);
  auto functions = solver.solve(classes, topology.families.natural, execution);
  add_loop_indicators(topology, functions);
  return functions;
}

void write_uv_map(const Structure& s, const uv::UvArray& function, const Eigen::VectorXcd& p,
                  Eigen::Ref<uv::UvArray> corners, Workers& workers) {
  uv::write_uv_map(*s.surface, s.topology.sheets, function, p, corners, workers);
  // At a pole the function is infinite: the triangles of its star get apexes in the plane.
  uv::place_apexes(*s.surface, s.stars(), corners);
  require_finite(corners, "corner", workers);
}

double uv_area(const Structure& s, const Eigen::VectorXcd& p) {
  // du and dv = *du have the same energy, and int du ^ dv is that energy.
  const auto& G = s.holomorphic().star.natural_gram;
  const Eigen::VectorXd r = p.head(G.rows()).real();
  return r.dot(G * r);
}

Structure cut_along(Structure s, std::vector<int> edges, const std::vector<int>& labels, Execution& execution) {
  // In the star of a pole the triangles have no common image: its spokes are seams in any case.
  const std::vector<int> also = spokes(s);
  edges.insert(edges.end(), also.begin(), also.end());
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  const auto half_edges = mesh::half_edges(*s.surface, execution);
  s.topology.sheets = uv::corner_sheets(*s.surface, half_edges, edges, s.topology.classes, execution, labels);
  s.topology.seams = std::move(edges);
  return s;
}

std::vector<int> spokes(const Structure& s) {
  std::vector<int> edges;
  for (const mesh::Star& star : s.stars()) {
    for (const int t : star.faces) {
      for (const int e : s.surface->triangle_edges[t]) {
        const auto [a, b] = s.surface->edges[e];
        if (a == star.vertex || b == star.vertex) edges.push_back(e);
      }
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

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
