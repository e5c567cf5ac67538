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

// Dijkstra along the artist's edges: fills T and returns the distances from the root.
std::vector<double> shortest_path_tree(const mesh::Surface& surface, const HalfEdges& mesh, int root,
                                       FundamentalDomain& domain, Progress& progress) {
  const std::size_t vertex_count = mesh.n_vertices();
  std::vector<double> distance(vertex_count, std::numeric_limits<double>::infinity());
  std::vector<char> settled(vertex_count, 0);
  domain.to_parent_vertex.assign(vertex_count, HalfedgeHandle());
  domain.vertex_depth.assign(vertex_count, 0);
  std::priority_queue<Entry, std::vector<Entry>, Nearer> queue;
  distance[root] = 0;
  queue.push({0.0, root});
  for (std::size_t done = 0; !queue.empty();) {
    const int v = queue.top().index;
    queue.pop();
    if (settled[v]) continue;
    settled[v] = 1;
    if (++done % kReportEvery == 0)
      progress.report(0.5 * static_cast<double>(done) / static_cast<double>(vertex_count));
    const HalfedgeHandle parent = domain.to_parent_vertex[v];
    if (parent.is_valid()) domain.vertex_depth[v] = domain.vertex_depth[to_vertex(mesh, parent)] + 1;
    const HalfedgeHandle start = mesh.halfedge_handle(VertexHandle(v));
    HalfedgeHandle h = start;
    do {
      const int w = to_vertex(mesh, h), e = edge_of(h);
      const double through = distance[v] + surface.edge_lengths[e];
      if (!surface.is_diagonal(e) && !settled[w] && through < distance[w]) {
        distance[w] = through;
        domain.to_parent_vertex[w] = opposite(h);
        queue.push({through, w});
      }
      h = next(mesh, opposite(h));
    } while (h != start);
  }
  return distance;
}

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

// Length of the loop that an edge closes in T; infinite for diagonals, negative for the edges of T.
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
  return key;
}

}  // namespace

FundamentalDomain fundamental_domain(const mesh::Surface& surface, const HalfEdges& half_edges, Progress& progress) {
  FundamentalDomain domain;
  const std::vector<double> distance = shortest_path_tree(surface, half_edges, 0, domain, progress);
  const std::vector<double> key = loop_lengths(surface, domain, distance);
  grow_domain(half_edges, key, domain, progress);
  for (int e = 0; e < static_cast<int>(key.size()); ++e) {
    if (!domain.crossed[e] && key[e] >= 0) domain.left_over.push_back(e);
  }
  return domain;
}

std::vector<int> cut_graph(const HalfEdges& mesh, const FundamentalDomain& domain) {
  std::vector<char> in_graph(mesh.n_edges());
  std::vector<int> degree(mesh.n_vertices(), 0), dangling;
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
    if (in_graph[e]) graph.push_back(e);
  }
  return graph;
}

}  // namespace holomorph::topology
