#include "mesh/surface_walk.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>

#include "mesh/triangle_geometry.h"

namespace holomorph::mesh {

namespace {

using Complex = std::complex<double>;

constexpr double kInwards = 1e-3;  // part of the way to the centre

double cross(Complex a, Complex b) { return a.real() * b.imag() - a.imag() * b.real(); }

// The side through which a point leaves a triangle, and the part of dz until then; part >= 1: it stays inside.
struct Exit {
  int side = -1;
  double part = INFINITY;
};

Exit exit_of(const std::array<Complex, 3>& corner, Complex z, Complex dz) {
  Exit exit;
  for (int i = 0; i < 3; ++i) {
    const Complex side = corner[(i + 1) % 3] - corner[i];
    const double outwards = cross(dz, side);  // > 0: towards the right of the side, which is outside
    if (!(outwards > 0)) continue;
    const double part = std::max(0.0, cross(corner[i] - z, side) / outwards);
    if (part < exit.part) exit = {i, part};
  }
  return exit;
}

}  // namespace

std::array<Complex, 3> corners(const Surface& surface, int triangle) {
  const auto [e0, e1, e2] = surface.triangle_edges[triangle];
  const double a = surface.edge_lengths[e0], b = surface.edge_lengths[e1], c = surface.edge_lengths[e2];
  return {0, a, Complex((a * a + (c - b) * (c + b)) / (2 * a), 2 * triangle_area(a, b, c) / a)};
}

Eigen::Vector3d barycentric(const Surface& surface, const SurfacePoint& point) {
  const auto corner = corners(surface, point.triangle);
  const double area = cross(corner[1], corner[2]);
  const double second = cross(point.z, corner[2]) / area, third = cross(corner[1], point.z) / area;
  const Eigen::Vector3d clamped = Eigen::Vector3d(1 - second - third, second, third).cwiseMax(0);
  return clamped / clamped.sum();
}

SurfacePoint at_vertex(const Surface& surface, int triangle, int vertex) {
  const auto corner = corners(surface, triangle);
  const auto& v = surface.triangles[triangle];
  const auto i = static_cast<std::size_t>(std::find(v.begin(), v.end(), vertex) - v.begin());
  const Complex centre = (corner[0] + corner[1] + corner[2]) / 3.0;
  return {triangle, corner[i] + kInwards * (centre - corner[i])};
}

WalkSteps walk(const Surface& surface, const HalfEdges& half_edges, const Sides& sides, SurfacePoint& point, Complex dz,
               int most_triangles) {
  WalkSteps steps;
  for (int n = 0; n < most_triangles; ++n) {
    const auto corner = corners(surface, point.triangle);
    const Exit exit = exit_of(corner, point.z, dz);
    const double part = std::min(1.0, exit.part);
    steps.emplace_back(point.triangle, part * dz);
    point.z += part * dz;
    if (exit.part >= 1) break;
    dz *= 1 - part;
    const HalfedgeHandle across = opposite(sides(point.triangle, exit.side));
    const int next = face_of(half_edges, across);
    if (next < 0) break;
    int side = 0;
    while (sides(next, side) != across) ++side;
    // The same edge in the two frames, once from either end.
    const auto other = corners(surface, next);
    const Complex here = corner[exit.side], there = other[(side + 1) % 3];
    Complex turn = (other[side] - there) / (corner[(exit.side + 1) % 3] - here);
    // A rotation alone, so that rounding does not change lengths along the walk.
    turn /= std::abs(turn);
    point = {next, there + turn * (point.z - here)};
    dz *= turn;
  }
  return steps;
}

std::array<int, 3> nearest_corners(const Surface& surface, const SurfacePoint& point) {
  const auto corner = corners(surface, point.triangle);
  std::array<int, 3> order{0, 1, 2};
  std::sort(order.begin(), order.end(),
            [&](int i, int j) { return std::abs(corner[i] - point.z) < std::abs(corner[j] - point.z); });
  for (int& i : order) i = surface.triangles[point.triangle][i];
  return order;
}

std::vector<double> graph_distances(const HalfEdges& half_edges, std::span<const double> lengths,
                                    const std::vector<int>& sources) {
  using Entry = std::pair<double, int>;
  std::vector<double> distance(half_edges.n_vertices(), std::numeric_limits<double>::infinity());
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  for (const int v : sources) {
    distance[v] = 0;
    queue.push({0.0, v});
  }
  while (!queue.empty()) {
    const auto [at, v] = queue.top();
    queue.pop();
    if (at > distance[v]) continue;
    const HalfedgeHandle start = half_edges.halfedge_handle(VertexHandle(v));
    if (!start.is_valid()) continue;
    HalfedgeHandle h = start;
    do {
      const int w = to_vertex(half_edges, h);
      const double through = at + lengths[edge_of(h)];
      if (through < distance[w]) queue.push({distance[w] = through, w});
      h = next(half_edges, opposite(h));
    } while (h != start);
  }
  return distance;
}

}  // namespace holomorph::mesh
