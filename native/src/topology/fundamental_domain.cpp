#include "topology/fundamental_domain.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "base/constants.h"
#include "topology/domain.h"

namespace holomorph::topology {
namespace {

using mesh::edge_of;
using mesh::face_of;
using mesh::next;
using mesh::opposite;
using mesh::to_vertex;

// Finds C. Outside T there are 2g edges more than a spanning tree of the dual graph has. Faces with one free edge are
// peeled until none is left: that edge is in C, and peeled faces form rooted trees. The 2g dual loops run through the
// remaining core, where Kruskal's algorithm chooses the edges with the longest loops. So C is the tree that Prim's
// algorithm finds with a queue of all faces, in linear time but for the core.
class DualTree {
 public:
  DualTree(const mesh::Surface& surface, const HalfEdges& half_edges, const Array<double>& distance,
           FundamentalDomain& domain)
      : surface_(surface), mesh_(half_edges), distance_(distance), domain_(domain), free_(half_edges.n_edges(), 1) {
    for (const HalfedgeHandle h : domain.to_parent_vertex) {
      if (h.is_valid()) free_[edge_of(h)] = 0;
    }
    for (const HalfedgeHandle h : domain.gaps) free_[edge_of(h)] = 0;
    domain.crossed.assign(half_edges.n_edges(), 0);
    domain.to_parent_face.assign(half_edges.n_faces(), HalfedgeHandle());
    domain.face_rank.resize(half_edges.n_faces());
    domain.face_order.reserve(half_edges.n_faces());
  }

  void grow(const std::vector<mesh::Star>& stars, Execution& execution) {
    const Array<int> peeled = peel_leaves(stars, execution);
    cut_core();
    root_core();
    // A face was peeled before its parent, so the reverse order has parents first.
    domain_.face_order.insert(domain_.face_order.end(), peeled.rbegin(), peeled.rend());
    for (std::size_t i = 0; i < domain_.face_order.size(); ++i)
      domain_.face_rank[domain_.face_order[i]] = static_cast<int>(i);
  }

 private:
  // The half-edge of edge e in face f, and the face across it.
  HalfedgeHandle inside(int f, int e) const {
    const HalfedgeHandle h(2 * e);
    return face_of(mesh_, h) == f ? h : opposite(h);
  }
  int across(int f, int e) const {
    // The exclusive or of both faces of e and of f: the other one.
    return face_of(mesh_, HalfedgeHandle(2 * e)) ^ face_of(mesh_, HalfedgeHandle(2 * e + 1)) ^ f;
  }

  // The free edges of a face: their number, and the exclusive or of their indices, which is the index of the last one.
  struct Links {
    int count, edges;
  };

  // Peels the faces of stars first, so that none of them becomes the root. @return the faces, each before its parent
  Array<int> peel_leaves(const std::vector<mesh::Star>& stars, Execution& execution) {
    const int faces = static_cast<int>(mesh_.n_faces());
    Array<Links> links(faces, {0, 0});
    for (int f = 0; f < faces; ++f) {
      for (const int e : surface_.triangle_edges[f])
        links[f] = {links[f].count + free_[e], links[f].edges ^ (free_[e] ? e : 0)};
    }
    Array<int> peeled;
    peeled.reserve(faces);
    const auto peel = [&](int f) {
      const int e = links[f].edges, parent = across(f, e);
      domain_.crossed[e] = 1;
      domain_.to_parent_face[f] = inside(f, e);
      peeled.push_back(f);
      links[f].count = 0;
      links[parent] = {links[parent].count - 1, links[parent].edges ^ e};
      return parent;
    };
    for (const mesh::Star& star : stars) {
      for (const HalfedgeHandle h : star.link) peel(face_of(mesh_, h));
    }
    for (int f = 0; f < faces; ++f) {
      execution.step(f, faces, 0.7, 1.0);
      // Peeling a face may make a leaf of its parent. What is left in the end is the core, whose faces have two free
      // edges or more, or a single face.
      for (int leaf = f; links[leaf].count == 1;) leaf = peel(leaf);
    }
    return peeled;
  }

  // Length of the loop that an edge closes in T; diagonals are crossed in any case.
  double loop_length(int e) const {
    if (surface_.is_diagonal(e)) return kInfinity;
    const auto [a, b] = surface_.edges[e];
    return distance_[a] + distance_[b] + surface_.edge_lengths[e];
  }

  void cut_core() {
    struct Candidate {
      double length;
      int edge;
    };
    std::vector<Candidate> candidates;
    for (int e = 0; e < static_cast<int>(free_.size()); ++e) {
      if (free_[e] && !domain_.crossed[e]) candidates.push_back({loop_length(e), e});
    }
    // Kruskal's algorithm, the longest loops first: the edges that would close a circle of faces have the shortest
    // loops. Ties go to the lower edge, so that the result is the same everywhere.
    std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
      return a.length != b.length ? a.length > b.length : a.edge < b.edge;
    });
    std::vector<int> part(candidates.empty() ? 0 : mesh_.n_faces());
    std::iota(part.begin(), part.end(), 0);
    const auto find = [&part](int f) {
      while (part[f] != f) f = part[f] = part[part[f]];
      return f;
    };
    for (const auto& [length, e] : candidates) {
      const int a = find(face_of(mesh_, HalfedgeHandle(2 * e))), b = find(face_of(mesh_, HalfedgeHandle(2 * e + 1)));
      if (a == b) {
        domain_.left_over.push_back(e);
      } else {
        part[a] = b;
        domain_.crossed[e] = 1;
      }
    }
    std::sort(domain_.left_over.begin(), domain_.left_over.end());
  }

  // Roots the core, breadth first, at the first face that was not peeled. Without a core that is the only one left.
  void root_core() {
    auto& order = domain_.face_order;
    const auto is_left = [](HalfedgeHandle h) { return !h.is_valid(); };
    const auto first = std::find_if(domain_.to_parent_face.begin(), domain_.to_parent_face.end(), is_left);
    const int root = static_cast<int>(first - domain_.to_parent_face.begin());
    order.push_back(root);
    for (std::size_t i = 0; i < order.size(); ++i) {
      for (const int e : surface_.triangle_edges[order[i]]) {
        const int f = across(order[i], e);
        if (!domain_.crossed[e] || f == root || domain_.to_parent_face[f].is_valid()) continue;
        domain_.to_parent_face[f] = inside(f, e);
        order.push_back(f);
      }
    }
  }

  const mesh::Surface& surface_;
  const HalfEdges& mesh_;
  const Array<double>& distance_;
  FundamentalDomain& domain_;
  Array<char> free_;  // #E neither in T nor a gap
};

}  // namespace

FundamentalDomain fundamental_domain(const mesh::Surface& surface, const HalfEdges& half_edges, Execution& execution,
                                     const std::vector<mesh::Star>& stars) {
  FundamentalDomain domain;
  domain.boundary = mesh::boundary_loops(surface, half_edges);
  // With boundary the root lies on loop 0, along which T runs at no cost.
  const int root = domain.boundary.count() == 0 ? 0 : mesh::from_vertex(half_edges, domain.boundary.loops[0][0]);
  const auto distance = grow_shortest_paths(surface, half_edges, stars, root, domain, execution);
  DualTree(surface, half_edges, distance, domain).grow(stars, execution);
  return domain;
}

std::vector<HalfedgeHandle> domain_boundary(const HalfEdges& half_edges, const FundamentalDomain& domain) {
  // Turns h around its tail to the first edge that is not crossed: a side of D.
  const auto outside = [&](HalfedgeHandle h) {
    while (domain.crossed[edge_of(h)]) h = next(half_edges, opposite(h));
    return h;
  };
  const HalfedgeHandle first = outside(half_edges.halfedge_handle(mesh::FaceHandle(domain.face_order[0])));
  std::vector<HalfedgeHandle> around;
  HalfedgeHandle h = first;
  do {
    // Step 3 of the paper: pairs h, -h cancel. With a stack, pairs that become neighbours by it cancel, too.
    if (!around.empty() && around.back() == opposite(h)) {
      around.pop_back();
    } else {
      around.push_back(h);
    }
    h = outside(next(half_edges, h));
  } while (h != first);
  // The list is cyclic: pairs across its start cancel as well.
  auto begin = around.begin(), end = around.end();
  for (; end - begin > 1 && *begin == opposite(*(end - 1)); --end) ++begin;
  return {begin, end};
}

// Outside T are the edges left over and the gaps. An edge of T dangles unless there is an end of these, or one of
// `ends`, on either side of it.
std::vector<int> cut_graph(const HalfEdges& half_edges, const FundamentalDomain& domain, const std::vector<int>& ends) {
  std::vector<int> graph = domain.left_over, terminals = ends;
  const auto add_ends = [&](HalfedgeHandle h) {
    terminals.push_back(to_vertex(half_edges, h));
    terminals.push_back(to_vertex(half_edges, opposite(h)));
  };
  for (const int e : domain.left_over) add_ends(HalfedgeHandle(2 * e));
  for (const HalfedgeHandle h : domain.gaps) add_ends(h);

  std::vector<char> visited(half_edges.n_vertices(), 0);
  std::vector<int> beyond(half_edges.n_vertices(), 0),
      on_paths;  // beyond: number of terminals whose path to the root has the vertex
  for (int v : terminals) {
    ++beyond[v];
    for (; !std::exchange(visited[v], 1); v = to_vertex(half_edges, domain.to_parent_vertex[v])) {
      on_paths.push_back(v);
      if (!domain.to_parent_vertex[v].is_valid()) break;
    }
  }
  std::sort(on_paths.begin(), on_paths.end(), [&](int v, int w) {
    return domain.vertex_rank[v] > domain.vertex_rank[w];  // each before its parent
  });
  for (const int v : on_paths) {
    const HalfedgeHandle h = domain.to_parent_vertex[v];
    if (!h.is_valid()) continue;
    beyond[to_vertex(half_edges, h)] += beyond[v];
    const int e = edge_of(h);
    if (beyond[v] < static_cast<int>(terminals.size()) && !half_edges.is_boundary(mesh::EdgeHandle(e)))
      graph.push_back(e);
  }
  std::sort(graph.begin(), graph.end());
  return graph;
}

}  // namespace holomorph::topology
