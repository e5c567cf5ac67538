#include "mesh/stars.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>
#include <set>
#include <string>

#include "base/constants.h"
#include "base/errors.h"
#include "mesh/surface.h"
#include "mesh/triangle_geometry.h"

namespace holomorph::mesh {

namespace {

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

// Angle at the apex of the triangle on side h.
double apex_angle(const HalfEdges& half_edges, std::span<const double> lengths, HalfedgeHandle h) {
  const HalfedgeHandle h1 = next(half_edges, h), h2 = next(half_edges, h1);
  const double a = lengths[edge_of(h)], b = lengths[edge_of(h1)], c = lengths[edge_of(h2)];
  // The law of cosines, by sine and cosine: atan2 is accurate at all angles, acos is not near 0 and pi.
  return std::atan2(4 * triangle_area(a, b, c), (b - a) * (b + a) + c * c);
}

// The place of the apex of the triangle on side h, where this side runs from 0 to 1.
std::complex<double> apex_place(const HalfEdges& half_edges, std::span<const double> lengths, HalfedgeHandle h) {
  const HalfedgeHandle h1 = next(half_edges, h), h2 = next(half_edges, h1);
  const double l = lengths[edge_of(h)], to_b = lengths[edge_of(h1)], to_a = lengths[edge_of(h2)];
  return {(l * l + (to_a - to_b) * (to_a + to_b)) / (2 * l * l), 2 * triangle_area(l, to_a, to_b) / (l * l)};
}

bool on_boundary(const HalfEdges& half_edges, int vertex) {
  return !half_edges.face_handle(half_edges.halfedge_handle(VertexHandle(vertex))).is_valid();
}

// Marks the vertices of a star with its centre. Refuses those of another star, of the boundary, and any twice.
void claim(const HalfEdges& half_edges, const Star& star, const Labels& label, std::vector<int>& owner) {
  const std::string itself = "the faces around vertex " + label(star.vertex);
  const auto take = [&](int v) {
    if (owner[v] == star.vertex)
      throw TopologyError(itself + " touch each other at vertex " + label(v) + ": the mesh is too coarse there");
    if (owner[v] >= 0) {
      throw TopologyError("the faces around the vertices " + label(owner[v]) + " and " + label(star.vertex) +
                          " share vertex " + label(v) + ": take vertices farther apart, or subdivide the mesh");
    }
    owner[v] = star.vertex;
  };
  take(star.vertex);
  for (const HalfedgeHandle h : star.link) {
    const int v = to_vertex(half_edges, h);
    if (on_boundary(half_edges, v)) throw TopologyError(itself + " touch the boundary at vertex " + label(v));
    take(v);
  }
}

struct TriangleSide {
  int triangle, side;
};

// The side of another triangle of the same polygon that lies on the same diagonal.
TriangleSide across(const Surface& surface, TriangleSide s) {
  const int edge = surface.triangle_edges[s.triangle][s.side], face = surface.triangle_faces[s.triangle];
  for (const int step : {-1, 1}) {
    for (int t = s.triangle + step;
         t >= 0 && t < static_cast<int>(surface.triangles.size()) && surface.triangle_faces[t] == face; t += step) {
      for (int i = 0; i < 3; ++i) {
        if (surface.triangle_edges[t][i] == edge) return {t, i};
      }
    }
  }
  throw Error("diagonal " + std::to_string(edge) + " has one triangle");
}

// Refuses polygons with two of the vertices. @return #V 1 for each of the vertices
std::vector<char> refuse_shared_polygons(const Surface& surface, const std::vector<int>& vertices,
                                         const Labels& label) {
  std::vector<char> chosen(surface.vertex_count, 0);
  for (const int v : vertices) chosen[v] = 1;
  const auto& offsets = surface.polygons.face_offsets;
  for (std::size_t f = 0; f + 1 < offsets.size(); ++f) {
    int first = -1;
    for (auto c = offsets[f]; c < offsets[f + 1]; ++c) {
      const int v = surface.polygons.corner_vertices[c];
      if (!chosen[v]) continue;
      if (first >= 0 && first != v) {
        throw TopologyError("the vertices " + label(first) + " and " + label(v) +
                            " are corners of one face: take vertices farther apart, or subdivide the mesh");
      }
      first = v;
    }
  }
  return chosen;
}

// Flips the diagonal x -> y of triangle s: it joins the other corners of s and of the triangle across it then.
void flip(Surface& surface, TriangleSide s) {
  const TriangleSide o = across(surface, s);
  const auto corner = [&](const TriangleSide& side, int i) {
    return surface.triangle_corners[side.triangle][(side.side + i) % 3];
  };
  const auto edge = [&](const TriangleSide& side, int i) {
    return surface.triangle_edges[side.triangle][(side.side + i) % 3];
  };
  const int e = edge(s, 0);
  const int x = corner(s, 0), y = corner(s, 1), a = corner(s, 2), b = corner(o, 2);
  const Triple first_edges{edge(s, 2), edge(o, 1), e}, second_edges{edge(o, 2), edge(s, 1), e};
  surface.triangle_corners[s.triangle] = {a, x, b};
  surface.triangle_corners[o.triangle] = {b, y, a};
  surface.triangle_edges[s.triangle] = first_edges;
  surface.triangle_edges[o.triangle] = second_edges;
  for (const int t : {s.triangle, o.triangle}) {
    for (int i = 0; i < 3; ++i)
      surface.triangles[t][i] = surface.polygons.corner_vertices[surface.triangle_corners[t][i]];
  }
  const auto [low, high] = std::minmax(surface.triangles[s.triangle][0], surface.triangles[o.triangle][0]);
  surface.edges[e] = {low, high};
  surface.edge_lengths[e] = distance(surface.polygons.vertices[low], surface.polygons.vertices[high]);
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
  std::vector<double> distance(half_edges.n_vertices(), kInfinity);
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

Star star(const HalfEdges& half_edges, std::span<const double> lengths, int vertex, const std::vector<int>& labels) {
  const Labels label(labels);
  Star result;
  result.vertex = vertex;
  const HalfedgeHandle start = half_edges.halfedge_handle(VertexHandle(vertex));
  if (!start.is_valid()) throw TopologyError("vertex " + label(vertex) + " belongs to no face");
  HalfedgeHandle h = start;
  do {  // h leaves the vertex; the face to its left is the next one counter-clockwise
    if (!half_edges.face_handle(h).is_valid())
      throw TopologyError("vertex " + label(vertex) + " lies on the boundary; an interior one is needed");
    const HalfedgeHandle outer = next(half_edges, h);
    result.link.push_back(outer);
    result.faces.push_back(face_of(half_edges, outer));
    result.angles.push_back(apex_angle(half_edges, lengths, outer));
    result.apexes.push_back(apex_place(half_edges, lengths, outer));
    result.total_angle += result.angles.back();
    h = opposite(next(half_edges, outer));
  } while (h != start);
  return result;
}

std::vector<int> star_vertices(const Surface& surface, const HalfEdges& half_edges, int vertex) {
  std::vector<int> vertices{vertex};
  const HalfedgeHandle start = half_edges.halfedge_handle(VertexHandle(vertex));
  HalfedgeHandle h = start;
  do {
    if (!surface.is_diagonal(edge_of(h))) vertices.push_back(to_vertex(half_edges, h));
    h = next(half_edges, opposite(h));
  } while (h != start);
  return vertices;
}

std::vector<Star> stars(const HalfEdges& half_edges, std::span<const double> lengths, const std::vector<int>& vertices,
                        const std::vector<int>& labels) {
  const Labels label(labels);
  std::vector<Star> result;
  std::vector<int> owner(half_edges.n_vertices(), -1);
  for (const int v : vertices) {
    result.push_back(star(half_edges, lengths, v, labels));
    claim(half_edges, result.back(), label, owner);
  }
  return result;
}

std::vector<int> corners_around(const Surface& surface, const HalfEdges& half_edges, int vertex) {
  const auto& [positions, corner_vertices, offsets, file] = surface.polygons;
  std::vector<int> vertices;
  const HalfedgeHandle start = half_edges.halfedge_handle(VertexHandle(vertex));
  HalfedgeHandle h = start;
  do {
    if (half_edges.face_handle(h).is_valid()) {
      const int polygon = surface.triangle_faces[face_of(half_edges, h)];
      vertices.insert(vertices.end(), corner_vertices.begin() + offsets[polygon],
                      corner_vertices.begin() + offsets[polygon + 1]);
    }
    h = next(half_edges, opposite(h));
  } while (h != start);
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

bool has_proper_star(const Surface& surface, const HalfEdges& half_edges, int vertex) {
  if (!half_edges.halfedge_handle(VertexHandle(vertex)).is_valid()) return false;
  std::vector<int> vertices = star_vertices(surface, half_edges, vertex);
  if (std::any_of(vertices.begin(), vertices.end(), [&](int v) { return on_boundary(half_edges, v); })) return false;
  std::sort(vertices.begin(), vertices.end());
  return std::adjacent_find(vertices.begin(), vertices.end()) == vertices.end();
}

bool has_free_star(const Surface& surface, const HalfEdges& half_edges, int vertex, const std::vector<char>& taken) {
  if (!has_proper_star(surface, half_edges, vertex)) return false;
  const std::vector<int> vertices = star_vertices(surface, half_edges, vertex);
  return std::none_of(vertices.begin(), vertices.end(), [&](int v) { return taken[v]; });
}

void mark_star(const Surface& surface, const HalfEdges& half_edges, int vertex, std::vector<char>& taken) {
  for (const int v : star_vertices(surface, half_edges, vertex)) taken[v] = 1;
}

void flip_diagonals_away(Surface& surface, const std::vector<int>& vertices, const std::vector<int>& labels) {
  if (surface.intrinsic()) return;  // triangles have no diagonals
  const std::vector<char> chosen = refuse_shared_polygons(surface, vertices, Labels(labels));
  for (int t = 0; t < static_cast<int>(surface.triangles.size()); ++t) {
    // Each flip lowers the number of the polygon's diagonals at its one chosen corner.
    for (int i = 0; i < 3;) {
      const int e = surface.triangle_edges[t][i];
      if (surface.is_diagonal(e) && (chosen[surface.edges[e][0]] || chosen[surface.edges[e][1]])) {
        flip(surface, {t, i});
        i = 0;
      } else {
        ++i;
      }
    }
  }
}

std::vector<int> vertices_around(const HalfEdges& half_edges, int vertex, std::size_t most) {
  std::vector<int> queue{vertex};
  std::set<int> seen{vertex};
  for (std::size_t at = 0; at < queue.size() && queue.size() < most; ++at) {
    const HalfedgeHandle first = half_edges.halfedge_handle(VertexHandle(queue[at]));
    HalfedgeHandle h = first;
    do {
      const int v = to_vertex(half_edges, h);
      if (seen.insert(v).second) queue.push_back(v);
      h = next(half_edges, opposite(h));
    } while (h != first);
  }
  return queue;
}

bool are_apart(const std::vector<int>& a, const std::vector<int>& b) {
  for (auto x = a.begin(), y = b.begin(); x != a.end() && y != b.end();) {
    if (*x == *y) return false;
    ++(*x < *y ? x : y);
  }
  return true;
}

}  // namespace holomorph::mesh
