#include "structure/punctured_structure.h"

#include <algorithm>
#include <cmath>

#include "mesh/intrinsic_triangulation.h"
#include "mesh/metric_errors.h"
#include "structure/guarantee.h"
#include "structure/harmonic_systems.h"
#include "structure/invariants.h"

namespace holomorph::structure {
namespace {

using Complex = std::complex<double>;
using mesh::edge_of;
using mesh::HalfedgeHandle;

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

// The classes of the poles alone, numbered from 0.
topology::IntegerForms pole_classes(const Topology& topology) {
  const int first = topology.families.harmonic(), count = topology.families.poles;
  topology::IntegerForms classes;
  classes.form_count = count;
  classes.rows.resize(topology.classes.rows.size());
  for (const int e : topology.classes.rows.edges()) {
    for (const auto& [form, value] : topology::forms_between(topology.classes.rows[e], first, first + count))
      classes.rows.edit(e).emplace_back(form - first, value);
  }
  return classes;
}

forms::Poles poles_of(const Structure& s, const mesh::HalfEdges& half_edges, std::span<const double> lengths,
                      const Array<double>& weights) {
  const auto stars = static_cast<Eigen::Index>(s.stars.size());
  return {s.stars, forms::pole_residues(stars, s.topology.type.closed()), pole_classes(s.topology),
          forms::singular_part(half_edges, lengths, s.stars),
          forms::outer_weights(half_edges, lengths, weights, s.stars)};
}

// The harmonic functions, and how much of each form the differentials of the poles have.
void add_harmonic(const mesh::HalfEdges& half_edges, const Array<double>& weights, const forms::Poles& poles,
                  const forms::RowMajorMatrix& u, const Array<double>& errors, HarmonicSystems& systems, Structure& s,
                  Execution& execution) {
  const int natural = s.topology.families.natural;
  s.functions.resize(s.surface->vertex_count, 0);
  s.pole_parts.resize(0, s.topology.families.poles);
  if (natural == 0) return;
  const auto classes =
      harmonic_classes(s.topology, half_edges, topology::first_forms(s.topology.classes, natural, natural));
  s.functions = systems.solve(classes, natural, s.memory.block, execution).functions;
  complete(half_edges, weights, errors, classes, s, execution);
  forms::ClosedForms own{s.topology.classes, {}};
  own.functions.swap(s.functions);
  s.pole_parts = systems.solver().is_stiff() ? forms::harmonic_part(half_edges, weights, poles, u, own, s.gram[0])
                                             : forms::harmonic_part(half_edges, poles, own, s.gram[0]);
  s.functions.swap(own.functions);
}

// Behind the harmonic functions those of the poles.
void append(const forms::PoleFunctions& poles, forms::RowMajorMatrix& functions) {
  forms::RowMajorMatrix all(poles.u.rows(), functions.cols() + poles.u.cols() + poles.v.cols());
  all << functions, poles.u, poles.v;
  functions.swap(all);
}

// omega_i = d(u_i - sum_j C_ji h_j) + i dv_i with the residue 1 at puncture i, and theta_0 = sum r_i omega_i in front
// of the holomorphic forms.
Eigen::MatrixXcd differentials_with(const Punctures& punctures, const Structure& s) {
  const Families& families = s.topology.families;
  const Eigen::VectorXcd r =
      Eigen::Map<const Eigen::VectorXcd>(punctures.residues.data(), families.poles);  // closed: the last is the rest
  const auto& holomorphic = s.holomorphic.differentials;
  Eigen::MatrixXcd all = Eigen::MatrixXcd::Zero(families.count(), 1 + holomorphic.cols());
  all.col(0).head(families.natural) = -(s.pole_parts * r);
  all.col(0).segment(families.harmonic(), families.poles) = r;
  all.col(0).tail(families.poles) = Complex(0, 1) * r;
  all.topRightCorner(families.harmonic(), holomorphic.cols()) = holomorphic;
  return all;
}

// Largest |sum of theta_0 around a face| outside the stars over the largest value.
double closedness(const Structure& s, const Eigen::VectorXcd& theta) {
  const mesh::Surface& surface = *s.surface;
  std::vector<char> inside(surface.triangles.size(), 0);
  for (const mesh::Star& star : s.stars) {
    for (const int t : star.faces) inside[t] = 1;
  }
  const mesh::Sides side(surface);
  double worst = 0, largest = 0;
  for (int t = 0; t < static_cast<int>(inside.size()); ++t) {
    if (inside[t]) continue;
    Complex sum = 0;
    for (int i = 0; i < 3; ++i) {
      const HalfedgeHandle h = side(t, i);
      const Complex value = static_cast<double>(mesh::sign(h)) * theta[edge_of(h)];
      sum += value;
      largest = std::max(largest, std::abs(value));
    }
    worst = std::max(worst, std::abs(sum));
  }
  return worst / largest;
}

// Largest |int of theta_0 over a link - residue| over the residue.
double link_residual(const Structure& s, const Eigen::VectorXcd& theta) {
  double worst = 0;
  for (std::size_t i = 0; i < s.stars.size(); ++i) {
    Complex period = 0;
    for (const HalfedgeHandle h : s.stars[i].link) period += static_cast<double>(mesh::sign(h)) * theta[edge_of(h)];
    worst = std::max(worst, std::abs(period - s.punctures.residues[i]) / std::abs(s.punctures.residues[i]));
  }
  return worst;
}

void certify(const forms::ClosedForms& basis, double harmonicity, Structure& s) {
  const Eigen::VectorXcd p = s.differentials.col(0);
  Eigen::VectorXcd theta(static_cast<Eigen::Index>(s.surface->edges.size()));
  theta.real() = forms::combination(*s.surface, basis, p.real());
  theta.imag() = forms::combination(*s.surface, basis, p.imag());
  Certificate& certificate = s.certificate;
  forms::Residuals& residuals = certificate.residuals;
  residuals.harmonicity = std::max(residuals.harmonicity, harmonicity);
  residuals.closedness = std::max(residuals.closedness, closedness(s, theta));
  certificate.periods = std::max(certificate.periods, link_residual(s, theta));
}

}  // namespace

forms::Poles cut_at_punctures(Structure& s, const mesh::HalfEdges& half_edges, std::span<const double> lengths,
                              const Array<double>& weights, Execution& execution) {
  execution.stage("homology", 0.1, 0.25);
  s.topology = find_topology(*s.surface, half_edges, execution, {}, s.stars);
  return poles_of(s, half_edges, lengths, weights);
}

PuncturedSurface punctured_surface(std::shared_ptr<const mesh::Surface> given, Punctures punctures,
                                   Execution& execution) {
  PuncturedSurface made;
  Structure& result = made.structure;
  execution.stage("punctures", 0.0, 0.05);
  const bool closed = mesh::topological_type(*given).closed();
  mesh::HalfEdges half_edges = mesh::half_edges(*given, execution);
  result.punctures = placed(*given, half_edges, std::move(punctures), closed);
  auto& [vertices, residues, names] = result.punctures;
  auto flipped = std::make_shared<mesh::Surface>(*given);
  mesh::flip_diagonals_away(*flipped, vertices, names);
  result.surface = flipped;

  execution.stage("residues", 0.05, 0.1);
  made.half_edges = mesh::half_edges(*flipped, execution);
  const auto triangulation =
      mesh::intrinsic_triangulation(*flipped, made.half_edges.copy(execution.workers()), execution.workers());
  result.mollification = triangulation.mollification;
  result.stars = mesh::stars(made.half_edges, triangulation.lengths, vertices, names);
  if (residues.empty()) residues = default_residues(*given, half_edges, vertices, closed, execution);
  half_edges = {};
  made.weights = mesh::cotangent_weights(triangulation, execution);
  made.errors = mesh::energy_errors(triangulation.metric(), made.weights, execution.workers());
  made.poles = cut_at_punctures(result, made.half_edges, triangulation.lengths, made.weights, execution);
  return made;
}

Structure punctured_structure(std::shared_ptr<const mesh::Surface> given, Punctures punctures, const Options& options,
                              Execution& execution) {
  auto [result, half_edges, weights, errors, poles] =
      punctured_surface(std::move(given), std::move(punctures), execution);
  const mesh::Surface& surface = *result.surface;
  const Families& families = result.topology.families;
  const auto fixed = mesh::boundary_vertices(result.topology.boundary);
  result.memory = plan_memory({surface.vertex_count, static_cast<std::int64_t>(surface.edges.size()), families.count()},
                              options.solver, options.memory_limit, Keeping::all);
  HarmonicSystems systems(half_edges, weights, fixed, result.memory.choice, execution);

  execution.stage("differential of the third kind", 0.4, 0.6);
  const auto third = forms::pole_functions(half_edges, weights, poles, systems.solver(), fixed, execution);

  execution.stage("harmonic forms", 0.6, 0.9);
  add_harmonic(half_edges, weights, poles, third.u, errors, systems, result, execution);
  result.solver = systems.report();

  execution.stage("certificates", 0.9, 1.0);
  append(third, result.functions);
  result.differentials = differentials_with(result.punctures, result);
  forms::ClosedForms basis{result.topology.classes, {}};
  basis.functions.swap(result.functions);
  certify(basis, third.harmonicity, result);
  result.functions.swap(basis.functions);
  require_guaranteed(result);
  execution.finish();
  result.seconds = execution.seconds();
  return result;
}

}  // namespace holomorph::structure
