#include "structure/pole_structure.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/constants.h"
#include "base/errors.h"
#include "structure/structure.h"

namespace holomorph::structure {
namespace {

using mesh::edge_of;
using mesh::HalfedgeHandle;

// Chooses the vertices where none were given, and checks the poles.
Poles placed(const mesh::Surface& surface, const mesh::HalfEdges& half_edges, Poles poles, bool closed) {
  if (poles.vertices.empty() && poles.residues.empty()) {
    if (closed)
      poles.vertices = far_apart(surface, half_edges);
    else
      poles.vertices = {deepest_vertex(surface, half_edges)};
  }
  check_poles(poles, surface.vertex_count, closed);
  return poles;
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

// C, #natural x #pole forms: how much of each harmonic form the differentials of the poles have.
Eigen::MatrixXd harmonic_part(const Structure& s, const mesh::Discretisation& discretisation,
                              const forms::PoleForms& pole_forms, const forms::RowMajorMatrix& u, bool is_stiff) {
  if (s.topology.families.natural == 0) return Eigen::MatrixXd(0, s.topology.families.poles);
  const forms::ClosedForms own{s.topology.classes, *s.harmonic.functions};
  const Eigen::MatrixXd& G = s.harmonic.invariants.energies.gram[0];
  const auto& half_edges = discretisation.half_edges;
  return is_stiff ? forms::harmonic_part(half_edges, discretisation.weights, pole_forms, u, own, G)
                  : forms::harmonic_part(half_edges, pole_forms, own, G);
}

// The functions of the harmonic forms, followed by those of the poles.
std::shared_ptr<const forms::RowMajorMatrix> all_functions(const HarmonicForms& harmonic,
                                                           const forms::PoleFunctions& poles) {
  const auto& [u, v, harmonicity] = poles;
  const Eigen::Index count = harmonic.functions ? harmonic.functions->cols() : 0;
  forms::RowMajorMatrix all(u.rows(), count + u.cols() + v.cols());
  if (count > 0) all.leftCols(count) = *harmonic.functions;
  all.rightCols(u.cols() + v.cols()) << u, v;
  return std::make_shared<const forms::RowMajorMatrix>(std::move(all));
}

// omega_i = d(u_i - sum_j C_ji h_j) + i dv_i with the residue 1 at pole i, and theta_0 = sum r_i omega_i in front of
// the holomorphic forms.
Eigen::MatrixXcd differentials_with_poles(const Structure& s) {
  const Families& families = s.topology.families;
  const auto& [chosen, stars, C] = held(s.poles);
  const Eigen::VectorXcd r =
      Eigen::Map<const Eigen::VectorXcd>(chosen.residues.data(), families.poles);  // closed: the last is the rest
  const auto& holomorphic = s.holomorphic().differentials;
  Eigen::MatrixXcd all = Eigen::MatrixXcd::Zero(families.count(), 1 + holomorphic.cols());
  all.col(0).head(families.natural) = -(C * r);
  all.col(0).segment(families.harmonic(), families.poles) = r;
  // r (u + i v): v has the coefficient i r.
  all.col(0).tail(families.poles) = Complex(0, 1) * r;
  all.topRightCorner(families.harmonic(), holomorphic.cols()) = holomorphic;
  return all;
}

// Largest |sum of theta_0 around a face| outside the stars over the largest value.
double closedness(const Structure& s, const Eigen::VectorXcd& theta) {
  const mesh::Surface& surface = *s.surface;
  std::vector<char> inside(surface.triangles.size(), 0);
  for (const mesh::Star& star : s.stars()) {
    for (const int t : star.faces) inside[t] = 1;
  }
  const mesh::Sides side(surface);
  double worst = 0, largest = 0;
  for (int t = 0; t < static_cast<int>(inside.size()); ++t) {
    // In a star theta_0 is the singular part, which no edge values represent.
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
  const auto& [chosen, stars, harmonic_part] = held(s.poles);
  for (std::size_t i = 0; i < stars.size(); ++i) {
    Complex period = 0;
    for (const HalfedgeHandle h : stars[i].link) period += static_cast<double>(mesh::sign(h)) * theta[edge_of(h)];
    worst = std::max(worst, std::abs(period - chosen.residues[i]) / std::abs(chosen.residues[i]));
  }
  return worst;
}

// The certificate of the harmonic forms, and of theta_0 with it.
Certificate certified(const Structure& s, double harmonicity) {
  const Eigen::VectorXcd p = s.differentials.col(0);
  const forms::ClosedForms basis{s.topology.classes, *s.harmonic.functions};
  Eigen::VectorXcd theta(static_cast<Eigen::Index>(s.surface->edges.size()));
  theta.real() = forms::combination(*s.surface, basis, p.real());
  theta.imag() = forms::combination(*s.surface, basis, p.imag());
  Certificate certificate = s.harmonic.certificate;
  forms::Residuals& residuals = certificate.residuals;
  residuals.harmonicity = std::max(residuals.harmonicity, harmonicity);
  residuals.closedness = std::max(residuals.closedness, closedness(s, theta));
  certificate.periods = std::max(certificate.periods, link_residual(s, theta));
  return certificate;
}

}  // namespace

forms::PoleForms cut_at_poles(Structure& s, const mesh::Discretisation& discretisation, Execution& execution) {
  execution.stage("homology", 0.1, 0.25);
  const auto& stars = held(s.poles).stars;
  const auto& [half_edges, lengths, weights, errors, metric_error, mollification, flips] = discretisation;
  s.topology = find_topology(*s.surface, half_edges, execution, {}, stars);
  return {stars, forms::pole_residues(static_cast<Eigen::Index>(stars.size()), s.topology.type.closed()),
          pole_classes(s.topology), forms::singular_part(half_edges, lengths, stars),
          forms::outer_weights(half_edges, lengths, weights, stars)};
}

SurfaceWithPoles surface_with_poles(std::shared_ptr<const mesh::Surface> given, Poles poles, Execution& execution) {
  SurfaceWithPoles made;
  Structure& result = made.structure;
  execution.stage("stars", 0.0, 0.05);
  const bool closed = mesh::topological_type(*given).closed();
  const mesh::HalfEdges half_edges = mesh::half_edges(*given, execution);
  poles = placed(*given, half_edges, std::move(poles), closed);
  const auto& [vertices, residues, labels] = poles;
  auto flipped = std::make_shared<mesh::Surface>(*given);
  mesh::flip_diagonals_away(*flipped, vertices, labels);
  result.surface = flipped;

  execution.stage("residues", 0.05, 0.1);
  made.discretisation = mesh::on_input_with_errors(*flipped, mesh::half_edges(*flipped, execution), execution);
  result.record.mollification = made.discretisation.mollification;
  auto stars = mesh::stars(made.discretisation.half_edges, made.discretisation.lengths, vertices, labels);
  if (residues.empty()) poles.residues = default_residues(*given, half_edges, vertices, closed, execution);
  result.poles = PoleData{std::move(poles), std::move(stars), {}};
  made.pole_forms = cut_at_poles(result, made.discretisation, execution);
  return made;
}

Structure pole_structure(std::shared_ptr<const mesh::Surface> given, Poles poles, const Options& options,
                         Execution& execution) {
  auto [result, discretisation, pole_forms] = surface_with_poles(std::move(given), std::move(poles), execution);
  const auto fixed = mesh::boundary_vertices(result.topology.boundary);
  HarmonicSolver solver(discretisation, result.topology.families.count(), options, execution);
  result.record.memory = solver.plan();

  execution.stage("differential of the third kind", 0.4, 0.6);
  const auto third = forms::pole_functions(discretisation.half_edges, discretisation.weights, pole_forms,
                                           solver.systems(), fixed, execution);

  execution.stage("harmonic forms", 0.6, 0.9);
  if (result.topology.families.natural > 0)
    result.harmonic = harmonic_forms(*result.surface, result.topology, solver, execution);
  held(result.poles).harmonic_part =
      harmonic_part(result, discretisation, pole_forms, third.u, solver.systems().is_stiff());
  result.record.solver = solver.report();

  execution.stage("certificates", 0.9, 1.0);
  result.harmonic.functions = all_functions(result.harmonic, third);
  result.differentials = differentials_with_poles(result);
  result.harmonic.certificate = certified(result, third.harmonicity);
  require_guaranteed(result);
  execution.finish();
  result.record.seconds = execution.seconds();
  return result;
}

}  // namespace holomorph::structure
