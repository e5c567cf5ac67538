#include "plane/rectangle_corners.h"

#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "mesh/components.h"
#include "mesh/element_labels.h"

namespace holomorph::plane {
namespace {

using mesh::HalfedgeHandle;
using mesh::Labels;

// The vertices of the boundary, the surface on its left, from the lowest.
std::vector<int> around(const mesh::HalfEdges& half_edges, const mesh::BoundaryLoops& boundary) {
  std::vector<int> vertices;
  for (const HalfedgeHandle h : boundary.loops[0]) vertices.push_back(mesh::from_vertex(half_edges, h));
  // boundary_loops() has the hole on the left.
  std::reverse(vertices.begin() + 1, vertices.end());
  return vertices;
}

mesh::BoundaryLoops checked_boundary(const mesh::Surface& surface, const mesh::HalfEdges& half_edges) {
  auto boundary = mesh::boundary_loops(surface, half_edges);
  const auto type = mesh::topological_type(surface);
  if (type.genus == 0 && type.boundary_count == 1) return boundary;
  throw TopologyError("the surface has " + type.text() + "; rectangle corners need a disk");
}

// @param place #V index of each vertex in the loop, -1 for others
void check_corners(const std::vector<int>& corners, const std::vector<int>& place, const Labels& label) {
  if (corners.size() != 4)
    throw TopologyError("there are " + std::to_string(corners.size()) + " rectangle corners; four are needed");
  for (const int v : corners) {
    if (v < 0 || v >= static_cast<int>(place.size()))
      throw TopologyError("rectangle corner " + std::to_string(v) + " is not a vertex: there are " +
                          std::to_string(place.size()));
    if (std::count(corners.begin(), corners.end(), v) > 1)
      throw TopologyError("rectangle corner " + label(v) + " is given twice");
    if (place[v] < 0) throw TopologyError("rectangle corner " + label(v) + " does not lie on the boundary");
  }
}

Sides sides_of(const std::vector<int>& loop, const std::vector<int>& corners, int vertex_count, const Labels& label) {
  const int n = static_cast<int>(loop.size());
  std::vector<int> place(vertex_count, -1);
  for (int i = 0; i < n; ++i) place[loop[i]] = i;
  check_corners(corners, place, label);
  // Steps along the boundary from corner 0: corners in order have ascending ones.
  const auto steps = [&](int v) { return (place[v] - place[corners[0]] + n) % n; };
  std::vector<int> ordered(corners);
  std::sort(ordered.begin(), ordered.end(), [&](int a, int b) { return steps(a) < steps(b); });
  if (ordered != corners) {
    std::string order;
    for (const int v : ordered) order += (order.empty() ? "" : ", ") + label(v);
    throw TopologyError(
        "the rectangle corners are not in the order of the boundary, the surface on its left: that is " + order);
  }
  Sides result;
  for (int i = 0; i < 4; ++i) {
    const int end = i < 3 ? steps(corners[i + 1]) : n;
    for (int s = steps(corners[i]); s <= end; ++s) result[i].push_back(loop[(place[corners[0]] + s) % n]);
  }
  return result;
}

}  // namespace

Sides rectangle_sides(const mesh::Surface& surface, const mesh::HalfEdges& half_edges, const std::vector<int>& corners,
                      const std::vector<int>& labels) {
  const auto boundary = checked_boundary(surface, half_edges);
  return sides_of(around(half_edges, boundary), corners, surface.vertex_count, Labels(labels));
}

std::vector<int> collapsed_triangles(const mesh::Surface& surface, const Sides& sides) {
  std::vector<int> on(surface.vertex_count, 0);  // a bit for each side
  for (int i = 0; i < 4; ++i) {
    for (const int v : sides[i]) on[v] |= 1 << i;
  }
  std::vector<int> result;
  for (int t = 0; t < static_cast<int>(surface.triangles.size()); ++t) {
    const auto& [a, b, c] = surface.triangles[t];
    if (on[a] & on[b] & on[c]) result.push_back(t);
  }
  return result;
}

int boundary_length(const mesh::Surface& surface, Execution& execution) {
  return static_cast<int>(mesh::boundary_loops(surface, mesh::half_edges(surface, execution)).loops[0].size());
}

std::vector<int> quarter_corners(const mesh::Surface& surface, Execution& execution) {
  const auto half_edges = mesh::half_edges(surface, execution);
  const auto boundary = mesh::boundary_loops(surface, half_edges);
  const auto& loop = boundary.loops[0];  // the hole on its left: reversed at the end
  const int n = static_cast<int>(loop.size());
  if (n < 4) throw TopologyError("the boundary has three edges; four are needed for four corners");
  std::vector<double> until(n, 0.0);  // length from the first vertex to each
  for (int i = 1; i < n; ++i) until[i] = until[i - 1] + surface.edge_lengths[mesh::edge_of(loop[i - 1])];
  const double total = until.back() + surface.edge_lengths[mesh::edge_of(loop.back())];
  std::vector<int> corners;
  for (int k = 0, at = 0; k < 4; ++k, ++at) {
    // On to the vertex nearest to k quarters of the length. The corners still to come need a vertex each.
    while (at < n - (4 - k) && std::abs(until[at + 1] - k * total / 4) < std::abs(until[at] - k * total / 4)) ++at;
    corners.push_back(mesh::from_vertex(half_edges, loop[at]));
  }
  std::reverse(corners.begin() + 1, corners.end());
  return corners;
}

}  // namespace holomorph::plane
