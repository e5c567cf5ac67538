#include "topology/fundamental_domain.h"

#include <cassert>
#include <limits>
#include <queue>

namespace holomorph::topology {
namespace {

using mesh::edge_of;
using mesh::FaceHandle;
using mesh::next;
using mesh::opposite;
using mesh::to_vertex;
using mesh::VertexHandle;

constexpr std::size_t kReportEvery = 4096;

struct Entry {
  double key;
  int index;
};
// Equal keys: the lower index first, so that the result does not depend on the queue's inner order.
struct Nearer {
  bool operator()(const Entry& a, const Entry& b) const { return a.key != b.key ? a.key > b.key : a.index > b.index; }
};
struct Farther {
  bool operator()(const Entry& a, const Entry& b) const { return a.key != b.key ? a.key < b.key : a.index > b.index; }
};

// Dijkstra along the artist's edges: fills T and the distances from the root. A star is entered as a whole: with the
// first vertex of it that is settled come its centre and all its spokes. So is a boundary loop, at no cost, because the
// surface need not be cut along it.
class ShortestPathTree {
 public:
  ShortestPathTree(const mesh::Surface& surface, const HalfEdges& mesh, const std::vector<mesh::Star>& stars,
                   FundamentalDomain& domain)
      : surface_(surface), mesh_(mesh), stars_(stars), domain_(domain), star_of_(mesh.n_vertices(), -1) {
    const std::size_t n = mesh.n_vertices();
    distance.assign(n, std::numeric_limits<double>::infinity());
    settled_.assign(n, 0);
    domain_.to_parent_vertex.assign(n, HalfedgeHandle());
    domain_.vertex_depth.assign(n, 0);
    domain_.gaps.resize(domain_.boundary.loops.size());
    for (std::size_t s = 0; s < stars.size(); ++s) {
      star_of_[stars[s].vertex] = static_cast<int>(s);
      for (const HalfedgeHandle h : stars[s].link) star_of_[to_vertex(mesh, h)] = static_cast<int>(s);
    }
  }

  void grow(int root, Progress& progress) {
    distance[root] = 0;
    queue_.push({0.0, root});
    while (!queue_.empty()) {
      const int v = queue_.top().index;
      queue_.pop();
      if (settled_[v]) continue;
      settle(v);
      if (star_of_[v] >= 0) settle_star(v, stars_[star_of_[v]]);
      if (domain_.boundary.loop_of_vertex[v] >= 0) settle_loop(v);
      if (done_ % kReportEvery == 0)
        progress.report(0.5 * static_cast<double>(done_) / static_cast<double>(distance.size()));
    }
  }

  std::vector<double> distance;

 private:
  void settle(int v) {
    settled_[v] = 1;
    ++done_;
    const HalfedgeHandle parent = domain_.to_parent_vertex[v];
    if (parent.is_valid()) domain_.vertex_depth[v] = domain_.vertex_depth[to_vertex(mesh_, parent)] + 1;
    const HalfedgeHandle start = mesh_.halfedge_handle(VertexHandle(v));
    HalfedgeHandle h = start;
    do {
      const int w = to_vertex(mesh_, h), e = edge_of(h);
      const double through = distance[v] + surface_.edge_lengths[e];
      if (!surface_.is_diagonal(e) && !settled_[w] && through < distance[w]) reach(w, through, opposite(h));
      h = next(mesh_, opposite(h));
    } while (h != start);
  }

  void reach(int w, double at, HalfedgeHandle to_parent) {
    distance[w] = at;
    domain_.to_parent_vertex[w] = to_parent;
    queue_.push({at, w});
  }

  void settle_star(int first, const mesh::Star& star) {
    for (const HalfedgeHandle h : star.link) {
      if (to_vertex(mesh_, h) == first) join(star.vertex, first, next(mesh_, h));
    }
    for (const HalfedgeHandle h : star.link) join(to_vertex(mesh_, h), first, next(mesh_, h));
  }

  // `between` lies between v and its parent, in either direction; it becomes the way of v to its parent.
  void join(int v, int first, HalfedgeHandle between) {
    if (settled_[v]) return;
    distance[v] = distance[first];
    domain_.to_parent_vertex[v] = mesh::from_vertex(mesh_, between) == v ? between : opposite(between);
    settle(v);
  }

  // From v both ways to the edge opposite, which stays outside T.
  void settle_loop(int v) {
    std::vector<HalfedgeHandle> loop;
    const HalfedgeHandle start = mesh_.halfedge_handle(VertexHandle(v));
    HalfedgeHandle h = start;
    do {
      loop.push_back(h);
      h = next(mesh_, h);
    } while (h != start);
    const std::size_t middle = loop.size() / 2;
    domain_.gaps[domain_.boundary.loop_of_vertex[v]] = loop[middle];
    for (std::size_t i = 0; i < middle; ++i) join(to_vertex(mesh_, loop[i]), v, loop[i]);
    for (std::size_t i = loop.size() - 1; i > middle; --i) join(mesh::from_vertex(mesh_, loop[i]), v, loop[i]);
  }

  const mesh::Surface& surface_;
  const HalfEdges& mesh_;
  const std::vector<mesh::Star>& stars_;
  FundamentalDomain& domain_;
  std::vector<int> star_of_;  // #V star that the vertex belongs to, or -1
  std::vector<char> settled_;
  std::priority_queue<Entry, std::vector<Entry>, Nearer> queue_;
  std::size_t done_ = 0;
};

// Grows D by the face behind the edge of the largest key (Prim's maximum spanning tree of the dual graph).
void grow_domain(const HalfEdges& mesh, const std::vector<double>& key, FundamentalDomain& domain, Progress& progress) {
  const std::size_t face_count = mesh.n_faces();
  std::vector<char> inside(face_count, 0);
  domain.to_parent_face.assign(face_count, HalfedgeHandle());
  domain.face_depth.assign(face_count, 0);
  domain.face_order.reserve(face_count);
  domain.crossed.assign(mesh.n_edges(), 0);
  std::priority_queue<Entry, std::vector<Entry>, Farther> queue;  // half-edges of D with a face outside behind them
  const auto join = [&](int f) {
    inside[f] = 1;
    domain.face_order.push_back(f);
    HalfedgeHandle h = mesh.halfedge_handle(FaceHandle(f));
    for (int i = 0; i < 3; ++i, h = next(mesh, h)) {
      const double k = key[edge_of(h)];
      if (k >= 0 && !inside[mesh::face_of(mesh, opposite(h))]) queue.push({k, h.idx()});
    }
  };
  join(0);
  while (!queue.empty()) {
    const HalfedgeHandle out(queue.top().index);
    queue.pop();
    const int f = mesh::face_of(mesh, opposite(out));
    if (inside[f]) continue;
    domain.to_parent_face[f] = opposite(out);
    domain.face_depth[f] = domain.face_depth[mesh::face_of(mesh, out)] + 1;
    domain.crossed[edge_of(out)] = 1;
    join(f);
    if (domain.face_order.size() % kReportEvery == 0) {
      progress.report(0.5 + 0.5 * static_cast<double>(domain.face_order.size()) / static_cast<double>(face_count));
    }
  }
  assert(domain.face_order.size() == face_count);
}

// Length of the loop that an edge closes in T; infinite for diagonals, negative for the edges of T and of the boundary.
std::vector<double> loop_lengths(const mesh::Surface& surface, const FundamentalDomain& domain,
                                 const std::vector<double>& distance) {
  std::vector<double> key(surface.edges.size());
  for (int e = 0; e < static_cast<int>(key.size()); ++e) {
    const auto [a, b] = surface.edges[e];
    key[e] = surface.is_diagonal(e) ? std::numeric_limits<double>::infinity()
                                    : distance[a] + distance[b] + surface.edge_lengths[e];
  }
  for (const HalfedgeHandle h : domain.to_parent_vertex) {
    if (h.is_valid()) key[edge_of(h)] = -1;
  }
  for (const HalfedgeHandle h : domain.gaps) key[edge_of(h)] = -1;
  return key;
}

}  // namespace

FundamentalDomain fundamental_domain(const mesh::Surface& surface, const HalfEdges& half_edges, Progress& progress,
                                     const std::vector<mesh::Star>& stars) {
  FundamentalDomain domain;
  domain.boundary = mesh::boundary_loops(surface, half_edges);
  ShortestPathTree tree(surface, half_edges, stars, domain);
  tree.grow(domain.boundary.count() == 0 ? 0 : mesh::from_vertex(half_edges, domain.boundary.loops[0][0]), progress);
  const std::vector<double> key = loop_lengths(surface, domain, tree.distance);
  grow_domain(half_edges, key, domain, progress);
  for (int e = 0; e < static_cast<int>(key.size()); ++e) {
    if (!domain.crossed[e] && key[e] >= 0) domain.left_over.push_back(e);
  }
  return domain;
}

std::vector<int> cut_graph(const HalfEdges& mesh, const FundamentalDomain& domain, const std::vector<int>& ends) {
  std::vector<char> in_graph(mesh.n_edges());
  std::vector<int> degree(mesh.n_vertices(), 0), dangling;
  for (const int v : ends) degree[v] = 1;  // as if one more edge ended there
  for (int e = 0; e < static_cast<int>(in_graph.size()); ++e) {
    in_graph[e] = !domain.crossed[e];
    if (!in_graph[e]) continue;
    ++degree[to_vertex(mesh, HalfedgeHandle(2 * e))];
    ++degree[to_vertex(mesh, HalfedgeHandle(2 * e + 1))];
  }
  for (int v = 0; v < static_cast<int>(degree.size()); ++v) {
    if (degree[v] == 1) dangling.push_back(v);
  }
  while (!dangling.empty()) {
    const int v = dangling.back();
    dangling.pop_back();
    if (degree[v] != 1) continue;
    HalfedgeHandle h = mesh.halfedge_handle(VertexHandle(v));
    while (!in_graph[edge_of(h)]) h = next(mesh, opposite(h));
    in_graph[edge_of(h)] = 0;
    --degree[v];
    if (--degree[to_vertex(mesh, h)] == 1) dangling.push_back(to_vertex(mesh, h));
  }
  std::vector<int> graph;
  for (int e = 0; e < static_cast<int>(in_graph.size()); ++e) {
    if (in_graph[e] && !mesh.is_boundary(mesh::EdgeHandle(e))) graph.push_back(e);
  }
  return graph;
}

}  // namespace holomorph::topology
