#include "tiling/cones/net.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesh/triangle_geometry.h"

namespace holomorph::tiling {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kMostCotangent = 25;      // half of one: thinner angles would be stiff in the Laplacian
constexpr double kLeastSlack = 1e-5;       // of the mean length: by how much two sides of a triangle exceed the third
constexpr double kLeastEdgeWeight = 1e-4;  // of an edge: any positive weights make a connection with the wanted cones

// What all lengths are raised by, so that each triangle has angles (Sharp & Crane 2020, doi:10.1111/cgf.14069): 0 where
// none is degenerate.
double raise_of(const mesh::Surface& surface) {
  double sum = 0, most = 0;
  for (const double length : surface.edge_lengths) sum += length;
  const double least = kLeastSlack * sum / static_cast<double>(std::max<std::size_t>(surface.edges.size(), 1));
  for (const mesh::Triple& edges : surface.triangle_edges) {
    const double a = surface.edge_lengths[edges[0]], b = surface.edge_lengths[edges[1]],
                 c = surface.edge_lengths[edges[2]];
    if (mesh::is_degenerate(a, b, c)) most = std::max(most, least - (a + b + c - 2 * std::max({a, b, c})));
  }
  return most;
}

void lay_out(Net& net, const mesh::Surface& surface, int t, double raise) {
  const auto [e0, e1, e2] = surface.triangle_edges[t];
  const double a = surface.edge_lengths[e0] + raise, b = surface.edge_lengths[e1] + raise,
               c = surface.edge_lengths[e2] + raise;
  const double area = mesh::triangle_area(a, b, c);
  const Complex apex((a * a + (c - b) * (c + b)) / (2 * a), 2 * area / a);
  const Complex corners[3] = {0, a, apex};
  const bool counts =
      !mesh::is_degenerate(surface.edge_lengths[e0], surface.edge_lengths[e1], surface.edge_lengths[e2]);
  net.area[t] = counts ? area : 0;
  for (int i = 0; i < 3; ++i) {
    const int side = 3 * t + i;
    net.along[side] = corners[(i + 1) % 3] - corners[i];
    const double lengths[3] = {a, b, c};
    const double cotangent = mesh::cotangent(lengths[i], lengths[(i + 1) % 3], lengths[(i + 2) % 3], area);
    net.cotangent[side] = counts ? 0.5 * cotangent : 0;
  }
}

// The angle at the tail of a side, in its triangle.
double angle_at(const Net& net, int side) {
  return std::arg(-net.along[Net::before(side)] * std::conj(net.along[side]));
}

void find_twins(Net& net, int edges) {
  std::vector<int> other(edges, -1);
  for (int side = 0; side < net.side_count(); ++side) {
    int& known = other[net.edge[side]];
    if (known < 0) {
      known = side;
    } else {
      net.twin[side] = known;
      net.twin[known] = side;
    }
  }
}

// @return the number of boundary loops
int find_holes(Net& net) {
  std::vector<int> along(net.vertex_count(), -1);  // the side of the boundary that leaves a vertex
  for (int side = 0; side < net.side_count(); ++side) {
    if (net.twin[side] < 0) along[net.tail[side]] = side;
  }
  int loops = 0;
  for (int v = 0; v < net.vertex_count(); ++v) {
    if (along[v] < 0 || net.on_boundary[v]) continue;
    ++loops;
    bool is_hole = true;
    std::vector<int> loop;
    for (int w = v; !net.on_boundary[w]; w = net.head[along[w]]) {
      net.on_boundary[w] = 1;
      loop.push_back(w);
      if (net.is_line[along[w]]) is_hole = false;
    }
    if (!is_hole) continue;
    for (const int w : loop) net.hole[w] = v;
    net.defect[v] += 2 * kPi;
  }
  return loops;
}

}  // namespace

Net::Net(const mesh::Surface& surface, const std::vector<int>& lines)
    : tail(3 * surface.triangles.size()),
      head(tail.size()),
      edge(tail.size()),
      twin(tail.size(), -1),
      along(tail.size()),
      transport(tail.size(), 0.0),
      cotangent(tail.size()),
      weight(tail.size()),
      area(surface.triangles.size()),
      vertex_area(surface.vertex_count, 0.0),
      defect(surface.vertex_count, 2 * kPi),
      first(surface.vertex_count, -1),
      hole(surface.vertex_count, -1),
      on_boundary(surface.vertex_count, 0),
      is_line(tail.size(), 0) {
  const double raise = raise_of(surface);
  for (int t = 0; t < triangle_count(); ++t) {
    lay_out(*this, surface, t, raise);
    for (int i = 0; i < 3; ++i) {
      tail[3 * t + i] = surface.triangles[t][i];
      head[3 * t + i] = surface.triangles[t][(i + 1) % 3];
      edge[3 * t + i] = surface.triangle_edges[t][i];
    }
  }
  const int edges = static_cast<int>(surface.edges.size());
  find_twins(*this, edges);
  std::vector<char> is_line_edge(edges, 0);
  for (const int e : lines) is_line_edge[e] = 1;
  for (int side = 0; side < side_count(); ++side) is_line[side] = is_line_edge[edge[side]];
  const int loops = find_holes(*this);
  for (int side = 0; side < side_count(); ++side) {
    const int back = twin[side], v = tail[side];
    weight[side] = std::min(cotangent[side], kMostCotangent);
    if (back >= 0) {
      weight[side] += std::min(cotangent[back], kMostCotangent);
      transport[side] = std::arg(-along[back] * std::conj(along[side]));
    }
    weight[side] = std::max(weight[side], kLeastEdgeWeight);
    vertex_area[v] += area[side / 3] / 3;
    defect[v] -= angle_at(*this, side);
    if (first[v] < 0 || back < 0) first[v] = side;
    whole_area += area[side / 3] / 3;
  }
  int vertices = 0;
  for (int v = 0; v < vertex_count(); ++v) {
    vertices += first[v] >= 0;
    if (on_boundary[v]) defect[v] -= kPi;
  }
  genus = (2 - loops - (vertices - edges + triangle_count())) / 2;
}

std::vector<std::vector<int>> dual_loops(const Net& net) {
  std::vector<std::vector<int>> result;
  if (net.genus == 0) return result;
  // A tree of edges, holes contracted; a tree of triangles across the other edges; what is left closes a loop each.
  std::vector<std::vector<int>> leaving(net.vertex_count()), on_hole(net.vertex_count());
  for (int side = 0; side < net.side_count(); ++side) leaving[net.tail[side]].push_back(side);
  for (int v = 0; v < net.vertex_count(); ++v) {
    if (net.hole[v] >= 0) on_hole[net.hole[v]].push_back(v);
  }
  std::vector<char> seen(net.vertex_count(), 0), in_tree(net.side_count(), 0), reached(net.triangle_count(), 0);
  std::vector<int> queue;
  const auto visit = [&](int v) {
    const std::vector<int> one{v};
    for (const int w : net.hole[v] >= 0 ? on_hole[net.hole[v]] : one) {
      seen[w] = 1;
      queue.push_back(w);
    }
  };
  visit(net.tail[0]);
  for (std::size_t i = 0; i < queue.size(); ++i) {
    for (const int side : leaving[queue[i]]) {
      if (seen[net.head[side]] || net.twin[side] < 0) continue;
      in_tree[side] = in_tree[net.twin[side]] = 1;
      visit(net.head[side]);
    }
  }
  std::vector<int> entered(net.triangle_count(), -1);  // the side that the tree crosses into a triangle
  queue.assign(1, 0);
  reached[0] = 1;
  for (std::size_t i = 0; i < queue.size(); ++i) {
    for (int side = 3 * queue[i]; side < 3 * queue[i] + 3; ++side) {
      const int back = net.twin[side];
      if (back < 0 || in_tree[side] || reached[back / 3]) continue;
      reached[back / 3] = 1;
      entered[back / 3] = side;
      in_tree[side] = in_tree[back] = 1;
      queue.push_back(back / 3);
    }
  }
  for (int side = 0; side < net.side_count(); ++side) {
    if (net.twin[side] < side || in_tree[side]) continue;
    std::vector<int> loop;
    for (int s = entered[side / 3]; s >= 0; s = entered[s / 3]) loop.push_back(s);
    std::reverse(loop.begin(), loop.end());
    loop.push_back(side);
    for (int s = entered[net.twin[side] / 3]; s >= 0; s = entered[s / 3]) loop.push_back(net.twin[s]);
    result.push_back(std::move(loop));
  }
  return result;
}

}  // namespace holomorph::tiling
