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
  structure::Punctures punctures{vertices, std::vector<Complex>(vertices.size(), 1.0), names};
  punctures.residues.back() = -static_cast<double>(vertices.size() - 1);
  poles_ = make_structure(landscape, std::move(punctures), execution);
  const structure::Structure& s = *structure_;
  execution.stage("solver", 0.3, 0.6);
  systems_ = flipped_ ? nullptr : landscape.systems();
  if (!systems_) {
    const structure::Extent extent{s.surface->vertex_count, static_cast<std::int64_t>(s.surface->edges.size()), 2};
    const auto plan = structure::plan_memory(extent, options.solver, options.memory_limit, structure::Keeping::all);
    systems_ = std::make_shared<structure::HarmonicSystems>(half_edges(), weights(), std::vector<int>{}, plan.choice,
                                                            execution);
  }
  const structure::Structure& plain = landscape.structure();
  change_ = change_of_basis(plain.topology.classes, s);
  pole_parts_.resize(change_.rows(), s.topology.families.poles);
  if (change_.rows() == 0) return;
  // Away from the flipped diagonals the harmonic forms are those of the landscape, and integers are all that is wanted.
  const forms::ClosedForms harmonic{on_flipped(plain.topology.classes, *plain.surface, *s.surface, half_edges()),
                                    landscape.harmonic().functions};
  pole_parts_ = forms::harmonic_part(half_edges(), poles_, harmonic, plain.gram[0]);
}

forms::Poles ClosedMaps::make_structure(const Landscape& landscape, structure::Punctures punctures,
                                        Execution& execution) {
  if (landscape.surface().has_diagonals()) {
    auto made = structure::punctured_surface(landscape.structure().surface, std::move(punctures), execution);
    flipped_ = {std::move(made.half_edges), std::move(made.weights)};
    structure_ = std::make_shared<structure::Structure>(std::move(made.structure));
    return std::move(made.poles);
  }
  structure::Structure s;
  s.surface = landscape.structure().surface;
  s.punctures = std::move(punctures);
  structure::check_punctures(s.punctures, s.surface->vertex_count, true);
  s.stars = mesh::stars(landscape.half_edges(), landscape.lengths(), s.punctures.vertices, s.punctures.names);
  auto poles =
      structure::cut_at_punctures(s, landscape.half_edges(), landscape.lengths(), landscape.weights(), execution);
  structure_ = std::make_shared<structure::Structure>(std::move(s));
  return poles;
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
  return forms::function_with_poles(half_edges(), weights(), poles_, natural, form.periods,
                                    form.coefficients.segment(families.natural, families.poles), systems_->solver(),
                                    execution);
}

}  // namespace holomorph::tiling
