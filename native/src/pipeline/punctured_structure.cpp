#include "pipeline/punctured_structure.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "topology/puncture_classes.h"

namespace holomorph::pipeline {
namespace {

using Complex = std::complex<double>;
using mesh::edge_of;
using mesh::HalfedgeHandle;
using mesh::sign;

// Columns Re r and, unless all residues are real, Im r.
Eigen::MatrixXd real_columns(const std::vector<Complex>& residues) {
  const Eigen::VectorXcd r =
      Eigen::Map<const Eigen::VectorXcd>(residues.data(), static_cast<Eigen::Index>(residues.size()));
  const bool real = r.imag().isZero(0);
  Eigen::MatrixXd columns(r.size(), real ? 1 : 2);
  columns.col(0) = r.real();
  if (!real) columns.col(1) = r.imag();
  return columns;
}

// Column 0 + i column 1, which is 0 where there is none.
Eigen::VectorXcd joined(const Eigen::MatrixXd& columns) {
  Eigen::VectorXcd result = columns.col(0).cast<Complex>();
  if (columns.cols() > 1) result += Complex(0, 1) * columns.col(1).cast<Complex>();
  return result;
}

// With vertices, where none were chosen.
Punctures placed(const mesh::Surface& surface, const mesh::HalfEdges& half_edges, Punctures punctures, bool closed) {
  if (punctures.vertices.empty() && punctures.residues.empty()) {
    if (closed)
      punctures.vertices = far_apart(surface, half_edges);
    else
      punctures.vertices = {deepest_vertex(surface, half_edges)};
  }
  check_punctures(punctures, surface.vertex_count, closed);
  return punctures;
}

std::vector<int> seams(const mesh::HalfEdges& half_edges, const topology::FundamentalDomain& domain,
                       const Punctures& punctures, const std::vector<mesh::Star>& stars) {
  std::vector<int> result = topology::cut_graph(half_edges, domain, punctures.vertices);
  for (const mesh::Star& star : stars) {
    for (const HalfedgeHandle h : star.link) result.push_back(edge_of(mesh::next(half_edges, h)));
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

// theta_0 along half-edge 2e, outside the stars.
Complex theta(const PuncturedStructure& s, const forms::RowMajorMatrix& harmonic, int e) {
  const int head = mesh::to_vertex(s.half_edges, HalfedgeHandle(2 * e)),
            tail = mesh::to_vertex(s.half_edges, HalfedgeHandle(2 * e + 1));
  Complex value = s.at_vertex[head] - s.at_vertex[tail];
  const int handles = static_cast<int>(s.handle_part.size());
  for (const auto& [k, n] : s.classes.rows[e]) {
    if (k >= handles) value += static_cast<double>(n) * s.punctures.residues[k - handles];
  }
  for (int j = 0; j < handles; ++j) value += s.handle_part[j] * harmonic(0, j);
  return value;
}

Complex theta(const PuncturedStructure& s, int e) {
  return theta(s, forms::edge_values(s.half_edges, s.harmonic, e, e + 1), e);
}

double period_residual(const PuncturedStructure& s) {
  double worst = 0;
  for (std::size_t i = 0; i < s.stars.size(); ++i) {
    Complex period = 0;
    for (const HalfedgeHandle h : s.stars[i].link) period += static_cast<double>(sign(h)) * theta(s, edge_of(h));
    worst = std::max(worst, std::abs(period - s.punctures.residues[i]) / std::abs(s.punctures.residues[i]));
  }
  return worst;
}

// Largest |sum of theta_0 around a face| outside the stars over the largest value.
double closedness(const PuncturedStructure& s, Execution& execution) {
  std::vector<char> inside(s.half_edges.n_faces(), 0);
  for (const mesh::Star& star : s.stars) {
    for (const HalfedgeHandle h : star.link) inside[mesh::face_of(s.half_edges, h)] = 1;
  }
  double worst = 0, largest = 0;
  for (int f = 0; f < static_cast<int>(inside.size()); ++f) {
    execution.step(f, inside.size());
    if (inside[f]) continue;
    Complex sum = 0;
    HalfedgeHandle h = s.half_edges.halfedge_handle(mesh::FaceHandle(f));
    for (int i = 0; i < 3; ++i, h = mesh::next(s.half_edges, h)) {
      const Complex value = static_cast<double>(sign(h)) * theta(s, edge_of(h));
      sum += value;
      largest = std::max(largest, std::abs(value));
    }
    worst = std::max(worst, std::abs(sum));
  }
  return worst / largest;
}

}  // namespace

PuncturedStructure punctured_structure(const mesh::Surface& surface, Punctures punctures, const Options& options,
                                       Execution& execution) {
  PuncturedStructure result;
  result.surface = surface;

  execution.stage("punctures", 0.0, 0.05);
  const mesh::HalfEdges given = mesh::half_edges(surface, execution);
  result.closed = mesh::boundary_count(given) == 0;
  result.punctures = placed(surface, given, std::move(punctures), result.closed);
  mesh::turn_diagonals_away(result.surface, result.punctures.vertices, result.punctures.names);
  result.half_edges = mesh::half_edges(result.surface, execution);
  const auto triangulation =
      mesh::intrinsic_triangulation(result.surface, result.half_edges.copy(execution.workers()), execution.workers());
  result.mollification = triangulation.mollification;
  result.stars =
      mesh::stars(result.half_edges, triangulation.lengths, result.punctures.vertices, result.punctures.names);
  execution.stage("residues", 0.05, 0.1);
  auto& [vertices, residues, names] = result.punctures;  // found only now: vertices that cannot be are refused at once
  if (residues.empty()) residues = default_residues(surface, given, vertices, result.closed, execution);

  execution.stage("homology", 0.1, 0.25);
  const auto domain = topology::fundamental_domain(result.surface, result.half_edges, execution, result.stars);
  result.seams = seams(result.half_edges, domain, result.punctures, result.stars);
  auto classes = topology::cohomology_basis(result.half_edges, domain);
  if (!result.closed) topology::add_paths_between_loops(result.half_edges, domain, classes);
  forms::Singularities singularities;
  singularities.classes = topology::puncture_classes(result.half_edges, domain, result.stars);
  result.classes = topology::beside(classes, singularities.classes);
  result.sheets = uv::corner_sheets(result.surface, result.half_edges, domain, result.classes, execution);

  execution.stage("Laplacian", 0.25, 0.35);
  const auto weights = mesh::cotangent_weights(triangulation, execution);
  const auto& lengths = triangulation.lengths;
  singularities.residues = real_columns(result.punctures.residues);
  singularities.part = forms::singular_part(result.half_edges, lengths, result.stars, singularities.residues);
  singularities.outer_weights = forms::outer_weights(result.half_edges, lengths, weights, result.stars);
  auto laplacian = forms::laplacian(result.half_edges, weights, execution);

  execution.stage("differential of the third kind", 0.35, 0.6);
  const auto held = mesh::boundary_vertices(domain.boundary);
  const auto choice =
      solver::choose_method(options.solver, laplacian.size(), classes.form_count + 2 * singularities.residues.cols());
  const auto solver = solver::make_solver(choice.method, std::move(laplacian), held, execution);
  const auto pair = forms::third_kind(result.half_edges, weights, singularities, *solver, held, execution);
  result.residuals.harmonicity = pair.harmonicity;
  result.at_vertex = joined(pair.u) + Complex(0, 1) * joined(pair.v);

  execution.stage("harmonic forms", 0.6, 0.9);
  const int n = classes.form_count;
  result.harmonic = {classes, forms::RowMajorMatrix(surface.vertex_count, 0)};
  result.handle_part = Eigen::VectorXcd::Zero(n);
  result.periods = Eigen::MatrixXcd::Zero(n, 0);
  if (n > 0) {
    result.harmonic =
        forms::harmonic_basis(result.half_edges, weights, classes, *solver, solver::Condition::natural, execution);
    const Eigen::MatrixXd G = forms::gram_matrix(result.half_edges, weights, result.harmonic, execution);
    if (result.closed) {
      const auto canonical = topology::canonical_basis(topology::wedge_matrix(result.half_edges, classes, execution));
      result.periods = conformal::holomorphic_basis(G, canonical).periods;
    }
    result.handle_part =
        -joined(forms::harmonic_part(result.half_edges, singularities, result.stars, result.harmonic, G));
    result.residuals.harmonicity =
        std::max(result.residuals.harmonicity,
                 forms::residuals(result.half_edges, weights, result.harmonic, execution).harmonicity);
  }
  result.solver = solver_report(*solver, choice);

  execution.stage("certificates", 0.9, 1.0);
  result.residuals.closedness = closedness(result, execution);
  result.period_residual = period_residual(result);
  execution.finish();
  result.seconds = execution.seconds();
  return result;
}

uv::UvArray uv_map(const PuncturedStructure& s, const Eigen::VectorXcd& c, Workers& workers) {
  const auto handles = s.handle_part.size();
  const auto holomorphic = c.tail(c.size() - 1);
  Eigen::VectorXcd p(s.classes.form_count);
  p.head(handles) = s.periods * holomorphic + c[0] * s.handle_part;
  for (Eigen::Index i = handles; i < p.size(); ++i) p[i] = c[0] * s.punctures.residues[i - handles];
  const Eigen::VectorXcd at_vertex = c[0] * s.at_vertex + s.harmonic.functions.cast<Complex>() * p.head(handles);
  uv::UvArray values(at_vertex.size(), 2);
  values << at_vertex.real(), at_vertex.imag();
  uv::UvArray uv = uv::uv_map(s.surface, s.sheets, values, p, workers);
  uv::place_apexes(s.surface, s.half_edges, s.stars, uv);
  return uv;
}

Eigen::MatrixXcd edge_values(const PuncturedStructure& s) {
  const int edges = static_cast<int>(s.surface.edges.size());
  Eigen::MatrixXcd values(1 + s.periods.cols(), edges);
  for (int e = 0; e < edges; ++e) {
    const forms::RowMajorMatrix harmonic = forms::edge_values(s.half_edges, s.harmonic, e, e + 1);
    values(0, e) = theta(s, harmonic, e);
    values.col(e).tail(s.periods.cols()) = (harmonic.cast<Complex>() * s.periods).transpose();
  }
  for (const mesh::Star& star : s.stars) {
    for (const HalfedgeHandle h : star.link)
      values(0, edge_of(mesh::next(s.half_edges, h))) = std::numeric_limits<double>::quiet_NaN();
  }
  return values;
}

Eigen::VectorXcd disk_map(const PuncturedStructure& s) {
  Eigen::VectorXcd z = (Complex(0, 2 * std::numbers::pi) * s.at_vertex.array()).exp();
  z[s.stars[0].vertex] = 0;
  return z;
}

}  // namespace holomorph::pipeline
