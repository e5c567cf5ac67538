#include "topology/pulled_back_classes.h"

#include <algorithm>
#include <string>

#include "base/errors.h"
#include "progressive/refinement.h"
#include "topology/fundamental_domain.h"

namespace holomorph::topology {
namespace {

// Loops of vertices as rings of entries; the entries of one vertex are a list, so that a split finds them.
class LiftedLoops {
 public:
  LiftedLoops(const std::vector<std::vector<int>>& loops, int vertex_count)
      : first_(static_cast<std::size_t>(vertex_count), -1) {
    for (const auto& loop : loops) {
      starts_.push_back(static_cast<int>(entries_.size()));
      const int n = static_cast<int>(loop.size()), start = starts_.back();
      for (int i = 0; i < n; ++i) {
        entries_.push_back({loop[i], start + (i + n - 1) % n, start + (i + 1) % n, -1});
        add_to_list(start + i);
      }
    }
  }

  void split(int s, int t, const std::vector<int>& moved) {
    first_.push_back(-1);
    // An entry of v_s stays if both its neighbours do, and becomes v_t if both moved to v_t. If one moved, v_t is
    // inserted on that side.
    const auto is_moved = [&](int entry) {
      return std::find(moved.begin(), moved.end(), entries_[entry].vertex) != moved.end();
    };
    // The list of v_s is taken apart, and its entries are filed again under v_s or v_t.
    for (int e = std::exchange(first_[s], -1), following; e >= 0; e = following) {
      following = entries_[e].same_vertex;
      const bool before = is_moved(entries_[e].previous), after = is_moved(entries_[e].next);
      if (before && after) entries_[e].vertex = t;
      add_to_list(e);
      if (before != after) add_to_list(insert(t, before ? entries_[e].previous : e));
    }
  }

  std::vector<std::vector<int>> vertices() const {
    std::vector<std::vector<int>> loops;
    for (const int start : starts_) {
      loops.emplace_back();
      int e = start;
      do {
        loops.back().push_back(entries_[e].vertex);
        e = entries_[e].next;
      } while (e != start);
    }
    return loops;
  }

 private:
  struct Entry {
    int vertex, previous, next, same_vertex;
  };

  void add_to_list(int entry) {
    int& first = first_[entries_[entry].vertex];
    entries_[entry].same_vertex = first;
    first = entry;
  }
  int insert(int vertex, int after) {
    const int entry = static_cast<int>(entries_.size()), next = entries_[after].next;
    entries_.push_back({vertex, after, next, -1});
    entries_[after].next = entry;
    entries_[next].previous = entry;
    return entry;
  }

  std::vector<Entry> entries_;
  std::vector<int> first_;   // #V first entry of each vertex
  std::vector<int> starts_;  // one entry of each loop
};

// The numbers that the vertices' loops are to have, for the loops of a boundary.
std::vector<int> loop_numbers(const HalfEdges& half_edges, const mesh::BoundaryLoops& boundary,
                              const std::vector<int>& loop_of_vertex) {
  std::vector<int> number;
  for (const auto& loop : boundary.loops) number.push_back(loop_of_vertex[mesh::from_vertex(half_edges, loop[0])]);
  return number;
}

void renumber(const HalfEdges& half_edges, const std::vector<int>& loop_of_vertex, FundamentalDomain& domain) {
  const auto number = loop_numbers(half_edges, domain.boundary, loop_of_vertex);
  domain.boundary = mesh::renumbered(domain.boundary, number);
  const auto gaps = domain.gaps;
  for (std::size_t k = 0; k < gaps.size(); ++k) domain.gaps[number[k]] = gaps[k];
}

// The loops of a level as the base has numbered them.
mesh::BoundaryLoops boundary_in_order(const mesh::Surface& level, const std::vector<int>& map,
                                      const mesh::BoundaryLoops& base) {
  Execution silent;
  const HalfEdges half_edges = mesh::half_edges(level, silent);
  const auto boundary = mesh::boundary_loops(level, half_edges);
  std::vector<int> loop_of_vertex;
  for (const int v : map) loop_of_vertex.push_back(base.loop_of_vertex[v]);
  return mesh::renumbered(boundary, loop_numbers(half_edges, boundary, loop_of_vertex));
}

}  // namespace

std::vector<int> base_half_edges(const mesh::Surface& base, const mesh::Surface& surface, const std::vector<int>& map) {
  // The base has triangles only and no two edges with the same ends, and its edges are in lexicographic order.
  std::vector<int> half_edges;
  half_edges.reserve(surface.edges.size());
  for (const auto& [a, b] : surface.edges) {
    const int u = map[a], v = map[b], edge = u == v ? -1 : mesh::edge_between(base.edges, u, v);
    half_edges.push_back(edge < 0 ? -1 : 2 * edge + (u > v));
  }
  return half_edges;
}

IntegerForms pull_back_classes(const mesh::Surface& base, const IntegerForms& forms, const mesh::Surface& surface,
                               const std::vector<int>& map) {
  IntegerForms result;
  result.form_count = forms.form_count;
  result.rows.resize(surface.edges.size());
  const std::vector<int> half_edges = base_half_edges(base, surface, map);
  for (std::size_t e = 0; e < half_edges.size(); ++e) {
    // An edge that collapses to a vertex of the base has the value 0: its row stays empty.
    const int h = half_edges[e];
    if (h >= 0) result.rows.set(e, add({}, forms.rows[h / 2], h & 1 ? -1 : 1));
  }
  return result;
}

std::vector<std::vector<int>> lift_loops(const progressive::ProgressiveMesh& mesh, int splits,
                                         const std::vector<std::vector<int>>& loops) {
  for (std::size_t i = 0; i < loops.size(); ++i) {
    const auto& loop = loops[i];
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const int a = loop[k], b = loop[(k + 1) % loop.size()];
      if (mesh::edge_between(mesh.base.edges, a, b) < 0) {
        throw InvalidMesh("loop " + std::to_string(i) + " goes from vertex " + std::to_string(a) + " to " +
                          std::to_string(b) + ", and the base mesh has no such edge");
      }
    }
  }
  LiftedLoops lifted(loops, mesh.base_vertex_count());
  progressive::Refinement refinement(mesh, splits);
  for (int k = 0; k < splits; ++k) {
    refinement.split();
    lifted.split(mesh.splits[k].v_s, mesh.base_vertex_count() + k, refinement.moved());
  }
  return lifted.vertices();
}

BaseBases base_bases(const mesh::Surface& base, const std::vector<int>& loop_of_vertex) {
  Execution silent;
  const HalfEdges half_edges = mesh::half_edges(base, silent);
  FundamentalDomain domain = fundamental_domain(base, half_edges, silent);
  if (!loop_of_vertex.empty()) renumber(half_edges, loop_of_vertex, domain);
  BaseBases result{{}, natural_classes(half_edges, domain), {}, domain.boundary};
  if (domain.boundary.count() > 0) result.relative = relative_classes(half_edges, domain.boundary, result.classes);
  for (const auto& loop : homology_basis(half_edges, domain)) {
    result.loops.emplace_back();
    for (const auto h : loop) result.loops.back().push_back(mesh::from_vertex(half_edges, h));
  }
  return result;
}

DualBases lifted_bases(const progressive::ProgressiveMesh& mesh, int splits, const mesh::Surface& level) {
  return lifted_bases(mesh, splits, level, base_bases(mesh.base));
}

DualBases lifted_bases(const progressive::ProgressiveMesh& mesh, int splits, const mesh::Surface& level,
                       const BaseBases& base) {
  std::vector<int> map = progressive::vertex_map(mesh, 0);
  map.resize(static_cast<std::size_t>(level.vertex_count));
  DualBases bases;
  bases.boundary = boundary_in_order(level, map, base.boundary);
  bases.classes = pull_back_classes(mesh.base, base.classes, level, map);
  for (const auto& loop : lift_loops(mesh, splits, base.loops)) {
    bases.loops.emplace_back();
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const int a = loop[i], b = loop[(i + 1) % loop.size()];
      bases.loops.back().push_back(HalfedgeHandle(2 * mesh::edge_between(level.edges, a, b) + (a > b)));
    }
  }
  return bases;
}

}  // namespace holomorph::topology
