#include "structure/topology.h"

#include <algorithm>
#include <cassert>

#include "topology/fundamental_domain.h"
#include "topology/homology.h"

namespace holomorph::structure {
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

}  // namespace holomorph::structure
