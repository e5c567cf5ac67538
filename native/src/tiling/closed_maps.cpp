#include "tiling/closed_maps.h"

namespace holomorph::tiling {
namespace {

using Complex = std::complex<double>;
using Eigen::VectorXcd;
using mesh::edge_of;
using mesh::HalfedgeHandle;
using topology::IntegerForms;

// The classes on the surface with some diagonals flipped, by closedness: a diagonal is known where two other sides of a
// triangle are, and in every polygon some triangle has two sides of the polygon.
IntegerForms on_flipped(IntegerForms classes, const mesh::Surface& before, const mesh::Surface& after,
                        const mesh::HalfEdges& half_edges) {
  std::vector<int> pending;
  std::vector<char> unknown(after.edges.size(), 0);
  for (int e = after.polygon_edge_count; e < static_cast<int>(after.edges.size()); ++e) {
    if (before.edges[e] == after.edges[e]) continue;
    pending.push_back(e);
    unknown[e] = 1;
  }
  const auto resolve = [&](int e) {
    for (const HalfedgeHandle h : {HalfedgeHandle(2 * e), HalfedgeHandle(2 * e + 1)}) {
      const HalfedgeHandle a = mesh::next(half_edges, h), b = mesh::next(half_edges, a);
      if (unknown[edge_of(a)] || unknown[edge_of(b)]) continue;
      const int back = -mesh::sign(h);
      const auto along_a = topology::add({}, classes.rows[edge_of(a)], back * mesh::sign(a));
      classes.rows.set(e, topology::add(along_a, classes.rows[edge_of(b)], back * mesh::sign(b)));
      unknown[e] = 0;
      return true;
    }
    return false;
  };
  while (!pending.empty()) std::erase_if(pending, resolve);
  return classes;
}

}  // namespace

ClosedMaps::ClosedMaps(const Landscape& landscape, const std::vector<int>& vertices, const std::vector<int>& names,
                       const structure::Options& options, Execution& execution)
    : landscape_(landscape) {
  structure::Poles poles{vertices, std::vector<Complex>(vertices.size(), 1.0), names};
  poles.residues.back() = -static_cast<double>(vertices.size() - 1);
  poles_ = make_structure(landscape, std::move(poles), execution);
  const structure::Structure& s = *structure_;
  execution.stage("solver", 0.3, 0.6);
  solver_ = flipped_ ? nullptr : landscape.solver();
  if (!solver_) solver_ = std::make_shared<structure::HarmonicSolver>(discretisation(), 2, options, execution);
  const structure::Structure& plain = landscape.structure();
  change_ = change_of_basis(plain.topology.classes, s);
  pole_parts_.resize(change_.rows(), s.topology.families.poles);
  if (change_.rows() == 0) return;
  // Away from the flipped diagonals the harmonic forms are those of the landscape, and integers are all that is wanted.
  const auto& half_edges = discretisation().half_edges;
  const auto classes = on_flipped(plain.topology.classes, *plain.surface, *s.surface, half_edges);
  pole_parts_ = forms::harmonic_part(half_edges, poles_, {classes, *plain.harmonic.functions},
                                     plain.harmonic.invariants.energies.gram[0]);
}

forms::PoleForms ClosedMaps::make_structure(const Landscape& landscape, structure::Poles poles, Execution& execution) {
  if (landscape.surface().has_diagonals()) {
    auto made = structure::surface_with_poles(landscape.structure().surface, std::move(poles), execution);
    flipped_ = std::move(made.discretisation);
    structure_ = std::make_shared<structure::Structure>(std::move(made.structure));
    return std::move(made.pole_forms);
  }
  structure::Structure s;
  s.surface = landscape.structure().surface;
  structure::check_poles(poles, s.surface->vertex_count, true);
  auto stars = mesh::stars(discretisation().half_edges, discretisation().lengths, poles.vertices, poles.labels);
  s.poles = structure::PoleData{std::move(poles), std::move(stars), {}};
  auto pole_forms = structure::cut_at_poles(s, discretisation(), execution);
  structure_ = std::make_shared<structure::Structure>(std::move(s));
  return pole_forms;
}

SeamlessForm ClosedMaps::form(const VectorXcd& X, const VectorXcd& r, const TextureLattice& lattice) const {
  const auto& families = structure_->topology.families;
  VectorXcd periods = X - pole_parts_ * r;
  for (Complex& period : periods) period = lattice.nearest(period);
  SeamlessForm result{change_ * periods, VectorXcd(families.count())};
  result.coefficients << result.periods, r, Complex(0, 1) * r;
  return result;
}

uv::UvArray ClosedMaps::function(const SeamlessForm& form, Execution& execution) {
  execution.stage("function", 0.6, 1.0);
  const auto& topology = structure_->topology;
  const auto& families = topology.families;
  const auto natural = topology::first_forms(topology.classes, families.natural, families.natural);
  return forms::function_with_poles(discretisation().half_edges, discretisation().weights, poles_, natural,
                                    form.periods, form.coefficients.segment(families.natural, families.poles),
                                    solver_->systems(), execution);
}

}  // namespace holomorph::tiling
