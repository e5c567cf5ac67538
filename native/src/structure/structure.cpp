#include "structure/structure.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/errors.h"
#include "forms/closed_forms.h"
#include "forms/gram_matrices.h"
#include "mesh/components.h"
#include "mesh/stars.h"
#include "uv/uv_map.h"
#include "uv/zeros.h"

namespace holomorph::structure {
namespace {

// The sum of the residues may differ from 0 by rounding, relative to the sum of their sizes.
constexpr double kSumTolerance = 1e-12;
// Steps of the search for two far vertices. A pair whose distance still grows after these is far enough apart.
constexpr int kMostSteps = 8;

std::string text(std::complex<double> z) {
  std::ostringstream out;
  out << z.real();
  if (z.imag() != 0) out << (z.imag() > 0 ? " + " : " - ") << std::abs(z.imag()) << "i";
  return out.str();
}

// The vertex with a free star at the largest distance; -1 if there is none.
int farthest(const mesh::Surface& surface, const mesh::HalfEdges& half_edges, const std::vector<double>& distance,
             const std::vector<char>& taken) {
  std::vector<int> order;
  for (int v = 0; v < static_cast<int>(distance.size()); ++v) {
    if (std::isfinite(distance[v])) order.push_back(v);
  }
  // The first few of a sorted order are enough: a heap gives them one by one.
  const auto nearer = [&](int a, int b) { return distance[a] != distance[b] ? distance[a] < distance[b] : a > b; };
  std::make_heap(order.begin(), order.end(), nearer);
  for (; !order.empty(); order.pop_back()) {
    std::pop_heap(order.begin(), order.end(), nearer);
    if (mesh::has_free_star(surface, half_edges, order.back(), taken)) return order.back();
  }
  return -1;
}

std::string label(const Poles& poles, int vertex) {
  return std::to_string(poles.labels.empty() ? vertex : poles.labels[vertex]);
}

void check_vertices(const Poles& poles, int vertex_count, bool closed) {
  const auto& vertices = poles.vertices;
  std::vector<char> met(vertex_count, 0);
  for (const int v : vertices) {
    if (v < 0 || v >= vertex_count)
      throw TopologyError("pole " + std::to_string(v) + " is not a vertex: there are " + std::to_string(vertex_count));
    if (std::exchange(met[v], 1)) throw TopologyError("pole " + label(poles, v) + " is given twice");
  }
  if (closed && vertices.size() == 1) {
    throw TopologyError("pole " + label(poles, vertices[0]) +
                        " is the only one: a closed surface needs at least two, as the residues sum to 0");
  }
}

void check_residues(const Poles& poles, bool closed) {
  const auto& residues = poles.residues;
  if (residues.size() != poles.vertices.size()) {
    throw TopologyError("there are " + std::to_string(residues.size()) + " residues for " +
                        std::to_string(poles.vertices.size()) + " poles");
  }
  std::complex<double> sum = 0;
  double size = 0;
  for (std::size_t i = 0; i < residues.size(); ++i) {
    if (!(std::abs(residues[i]) > 0) || !std::isfinite(std::abs(residues[i])))
      throw TopologyError("residue " + std::to_string(i) + " is " + text(residues[i]) +
                          "; finite numbers other than 0 are needed");
    sum += residues[i];
    size += std::abs(residues[i]);
  }
  if (closed && std::abs(sum) > kSumTolerance * size)
    throw TopologyError("the residues sum to " + text(sum) + "; on a closed surface they must sum to 0");
}

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

std::vector<int> far_apart(const mesh::Surface& surface, const mesh::HalfEdges& half_edges) {
  const std::vector<char> nothing(surface.vertex_count, 0);
  const auto distances = [&](int v) { return mesh::graph_distances(half_edges, surface.edge_lengths, {v}); };
  // Any vertex does as a start, as in the double sweep for the diameter of a graph.
  int p = farthest(surface, half_edges, distances(0), nothing);
  std::vector<int> best;
  double apart = 0;
  // Repeated farthest points. The distance grows strictly, so that no pair recurs.
  for (int step = 0; p >= 0 && step < kMostSteps; ++step) {
    const std::vector<double> distance = distances(p);
    std::vector<char> taken = nothing;
    mesh::mark_star(surface, half_edges, p, taken);
    const int q = farthest(surface, half_edges, distance, taken);
    if (q < 0 || !(distance[q] > apart)) break;
    apart = distance[q];
    best = {std::min(p, q), std::max(p, q)};
    p = q;
  }
  if (best.empty())
    throw TopologyError(
        "the mesh is too coarse for two poles: the faces around any two vertices meet; subdivide the mesh");
  return best;
}

int deepest_vertex(const mesh::Surface& surface, const mesh::HalfEdges& half_edges) {
  const std::vector<int> boundary = mesh::boundary_vertices(mesh::boundary_loops(surface, half_edges));
  const std::vector<double> distance = mesh::graph_distances(half_edges, surface.edge_lengths, boundary);
  const int deepest = farthest(surface, half_edges, distance, std::vector<char>(surface.vertex_count, 0));
  if (deepest < 0)
    throw TopologyError("every vertex is next to the boundary: there is no room for a pole; subdivide the mesh");
  return deepest;
}

std::vector<std::complex<double>> default_residues(const mesh::Surface& surface, const mesh::HalfEdges& half_edges,
                                                   const std::vector<int>& vertices, bool closed,
                                                   Execution& execution) {
  std::vector<std::complex<double>> residues(vertices.size(), 1.0);
  if (!closed || vertices.empty()) return residues;
  // The residues must sum to 0. So the pole that is farthest from the others, by the sum of distances, takes what
  // balances the ones; of two poles it is the second.
  std::size_t last = vertices.size() - 1;
  if (vertices.size() > 2) {
    std::vector<double> sum(vertices.size(), 0.0);
    for (std::size_t from = 0; from < vertices.size(); ++from) {
      execution.report(static_cast<double>(from) / static_cast<double>(vertices.size()));
      const std::vector<double> distance = mesh::graph_distances(half_edges, surface.edge_lengths, {vertices[from]});
      for (std::size_t i = 0; i < vertices.size(); ++i) sum[i] += distance[vertices[i]];
    }
    last = static_cast<std::size_t>(std::max_element(sum.begin(), sum.end()) - sum.begin());
  }
  residues[last] = -static_cast<double>(vertices.size() - 1);
  return residues;
}

void check_poles(const Poles& poles, int vertex_count, bool closed) {
  check_vertices(poles, vertex_count, closed);
  if (!poles.residues.empty()) check_residues(poles, closed);
}

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
