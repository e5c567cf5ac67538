#include "mesh/make_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <queue>
#include <vector>

#include "base/workers.h"
#include "mesh/input_filter.h"
#include "mesh/orientation.h"
#include "mesh/polygon_edges.h"
#include "mesh/triangle_geometry.h"

namespace holomorph::mesh {
namespace {

using Eigen::Vector3d;
using Triangles = std::vector<std::array<int, 3>>;

// Cutting one polygon into triangles.

constexpr int kExactSize = 64;
// Cost of a triangle that is degenerate or inverted: above that of any other.
constexpr double kBadTriangle = 1e12;
// Below this ratio of area to squared size a triangle counts as degenerate.
constexpr double kNoTriangle = 1e-10;
// Added for a triangle with all corners on one boundary loop: more than any but a nearly degenerate shape costs.
constexpr double kOnOneLoop = 1e8;
// A difference of costs that rounding of the corners to single precision may make decides nothing: where the corners of
// a polygon lie on one circle, it would be cut otherwise in each copy. Over the largest coordinate in shortest sides.
constexpr double kTie = 32 * 0x1p-24, kMostTie = 1e-2;

class Polygon {
 public:
  Polygon(const std::vector<std::array<double, 3>>& corners, const std::vector<int>& loops) : loops_(loops) {
    // Relative to the first corner, so that a polygon far from the origin loses no digits.
    for (const auto& p : corners)
      points_.push_back(Vector3d(p[0] - corners[0][0], p[1] - corners[0][1], p[2] - corners[0][2]));
    Vector3d area = Vector3d::Zero();
    for (int i = 1; i + 1 < size(); ++i) area += points_[i].cross(points_[i + 1]);
    normal_ = area.normalized();
    double largest = 0, shortest = points_.back().norm();
    for (const auto& p : corners) largest = std::max({largest, std::abs(p[0]), std::abs(p[1]), std::abs(p[2])});
    for (int i = 1; i < size(); ++i) shortest = std::min(shortest, (points_[i] - points_[i - 1]).norm());
    tie_ = std::min(kMostTie, kTie * largest / shortest);
  }

  int size() const { return static_cast<int>(points_.size()); }
  double tie() const { return tie_; }

  double cost(int i, int j, int k) const {
    const Vector3d a = points_[j] - points_[i], b = points_[k] - points_[i];
    const double squares = a.squaredNorm() + b.squaredNorm() + (b - a).squaredNorm();
    const Vector3d cross = a.cross(b);
    const double facing = cross.dot(normal_), area = cross.norm();
    if (!(area > kNoTriangle * squares) || facing <= 0) return kBadTriangle;
    return squares / area + (on_one_loop(i, j, k) ? kOnOneLoop : 0.0);
  }

  // An inner corner cut off between two corners of one loop is lost for the diagonals of the others.
  bool is_last_inside(int before, int tip, int after) const {
    return !loops_.empty() && loops_[tip] < 0 && loops_[before] >= 0 && loops_[before] == loops_[after];
  }

 private:
  bool on_one_loop(int i, int j, int k) const {
    return !loops_.empty() && loops_[i] >= 0 && loops_[i] == loops_[j] && loops_[i] == loops_[k];
  }

  std::vector<Vector3d> points_;
  Vector3d normal_;
  double tie_ = 0;
  const std::vector<int>& loops_;
};

// best(i, k) = least cost of the sub-polygon i, i+1, .., k; the first of choices that cost the same is taken.
Triangles optimal(const Polygon& polygon) {
  const int n = polygon.size();
  std::vector<double> best(n * n, 0.0);
  std::vector<int> middle(n * n, -1);
  for (int width = 2; width < n; ++width) {
    for (int i = 0, k = width; k < n; ++i, ++k) {
      for (int j = i + 1; j < k; ++j) {
        const double cost = best[i * n + j] + best[j * n + k] + polygon.cost(i, j, k);
        if (j == i + 1 || cost < best[i * n + k] - polygon.tie()) best[i * n + k] = cost, middle[i * n + k] = j;
      }
    }
  }
  Triangles triangles;
  std::vector<std::array<int, 2>> open{{0, n - 1}};
  while (!open.empty()) {
    const auto [i, k] = open.back();
    open.pop_back();
    if (k - i < 2) continue;
    const int j = middle[i * n + k];
    triangles.push_back({i, j, k});
    open.push_back({i, j});
    open.push_back({j, k});
  }
  return triangles;
}

Triangles best_ears(const Polygon& polygon) {
  struct Ear {
    double cost;
    int before, tip, after;
    bool operator>(const Ear& other) const { return cost != other.cost ? cost > other.cost : tip > other.tip; }
  };
  const int n = polygon.size();
  std::vector<int> before(n), after(n);
  for (int i = 0; i < n; ++i) before[i] = (i + n - 1) % n, after[i] = (i + 1) % n;
  std::priority_queue<Ear, std::vector<Ear>, std::greater<>> queue;
  const auto push = [&](int tip) {
    const double later = polygon.is_last_inside(before[tip], tip, after[tip]) ? kOnOneLoop / 2 : 0.0;
    queue.push({polygon.cost(before[tip], tip, after[tip]) + later, before[tip], tip, after[tip]});
  };
  for (int i = 0; i < n; ++i) push(i);
  Triangles triangles;
  while (static_cast<int>(triangles.size()) < n - 2) {
    const Ear ear = queue.top();
    queue.pop();
    if (before[ear.tip] != ear.before || after[ear.tip] != ear.after) continue;  // a neighbour has been cut off since
    std::array<int, 3> t{ear.before, ear.tip, ear.after};
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    triangles.push_back(t);
    after[ear.before] = ear.after;
    before[ear.after] = ear.before;
    before[ear.tip] = after[ear.tip] = -1;
    push(ear.before);
    push(ear.after);
  }
  return triangles;
}

// Cuts a polygon into triangles: triples of its local corners 0 .. n-1, each in the polygon's own order (i < j < k).
// Minimises the sum of (a^2 + b^2 + c^2) / area over the triangles. This is the Delaunay triangulation where the
// polygon is planar and convex (Musin, Properties of the Delaunay triangulation, 1997, doi:10.1145/262839.263061).
// Triangles that lie against the polygon's vector area cost more than any that do not. Avoids triangles whose corners
// all lie on one boundary loop, where other diagonals have fewer of them. Maps that make the loop straight would
// collapse these.
// @param loops n boundary loops of the corners, -1 in the interior; empty: no corner is on the boundary
// Exact up to 64 corners, by dynamic programming, O(n^3). Above, it cuts off the best ear repeatedly, O(n log n).
Triangles triangulate_polygon(const std::vector<std::array<double, 3>>& corners, const std::vector<int>& loops) {
  if (corners.size() == 3) return {{0, 1, 2}};
  const Polygon polygon(corners, loops);
  return polygon.size() <= kExactSize ? optimal(polygon) : best_ears(polygon);
}

void resize_arrays(Surface& surface) {
  const Polygons& mesh = surface.polygons;
  const std::size_t corners = mesh.corner_vertices.size(), faces = mesh.face_offsets.size() - 1;
  const std::size_t edges = surface.edges.size() + corners - 3 * faces;
  surface.triangles.resize(corners - 2 * faces);
  surface.triangle_corners.resize(corners - 2 * faces);
  surface.triangle_edges.resize(corners - 2 * faces);
  surface.triangle_faces.resize(corners - 2 * faces);
  surface.edges.resize(edges);
  surface.edge_lengths.resize(edges);
  surface.edge_face_count.resize(edges);
}

// Writes the triangles of polygons, at places known from the number of corners before each polygon. Diagonals get new
// edges, each known to its two triangles only.
class PolygonCutter {
 public:
  PolygonCutter(Surface& surface, const PolygonEdges& edges, const std::vector<int>& loop_of_vertex)
      : surface_(surface), edges_(edges), loop_of_vertex_(loop_of_vertex) {}

  void cut(int face, bool reversed) {
    const auto& mesh = surface_.polygons;
    const int first = mesh.face_offsets[face], n = mesh.face_offsets[face + 1] - first;
    triangle_ = first - 2 * face;
    if (n == 3) return add(face, reversed, first, {0, 1, 2}, 3);
    diagonal_ = surface_.polygon_edge_count + first - 3 * face;
    points_.resize(n);
    loops_.resize(n);
    for (int i = 0; i < n; ++i) {
      points_[i] = mesh.vertices[mesh.corner_vertices[first + i]];
      loops_[i] = loop_of_vertex_[mesh.corner_vertices[first + i]];
    }
    diagonals_.clear();
    for (const auto& local : triangulate_polygon(points_, loops_)) add(face, reversed, first, local, n);
  }

 private:
  // The edge of the polygon's local corners i < j: one of its sides, or a diagonal.
  int edge(int first, int i, int j, int n) {
    if (j == i + 1) return edges_.side_edge[first + i];
    if (i == 0 && j == n - 1) return edges_.side_edge[first + j];
    const auto [known, is_new] = diagonals_.try_emplace(Pair{i, j}, diagonal_);
    if (!is_new) return known->second;
    const int a = surface_.polygons.corner_vertices[first + i], b = surface_.polygons.corner_vertices[first + j];
    surface_.edges[diagonal_] = {std::min(a, b), std::max(a, b)};
    surface_.edge_face_count[diagonal_] = 2;
    return diagonal_++;
  }

  void add(int face, bool reversed, int first, const Triple& local, int n) {
    const auto [i, j, k] = local;
    Triple corners{first + i, first + j, first + k};
    Triple sides{edge(first, i, j, n), edge(first, j, k, n), edge(first, i, k, n)};
    if (reversed) {
      std::swap(corners[1], corners[2]);
      std::swap(sides[0], sides[2]);
    }
    Triple vertices;
    for (int c = 0; c < 3; ++c) vertices[c] = surface_.polygons.corner_vertices[corners[c]];
    surface_.triangles[triangle_] = vertices;
    surface_.triangle_corners[triangle_] = corners;
    surface_.triangle_edges[triangle_] = sides;
    surface_.triangle_faces[triangle_++] = face;
  }

  Surface& surface_;
  const PolygonEdges& edges_;
  const std::vector<int>& loop_of_vertex_;  // #V, -1 in the interior; empty where all polygons are triangles
  int triangle_ = 0, diagonal_ = 0;         // the next ones
  std::vector<std::array<double, 3>> points_;
  // The polygon being cut: the boundary loop at each corner, and its diagonals by their local corners.
  std::vector<int> loops_;
  std::map<Pair, int> diagonals_;
};

void cut_polygons(Surface& surface, const PolygonEdges& edges, const std::vector<int>& loop_of_vertex,
                  const std::vector<char>& reversed, Workers& workers) {
  const int faces = static_cast<int>(surface.polygons.face_offsets.size()) - 1;
  run_throwing(workers, chunk_count(faces), [&](int chunk) {
    PolygonCutter cutter(surface, edges, loop_of_vertex);
    for (int f = chunk * kChunk, end = std::min(f + kChunk, faces); f < end; ++f) cutter.cut(f, reversed[f]);
  });
}

std::vector<EdgeMeeting> meetings_of(const Polygons& mesh, const PolygonEdges& edges) {
  const std::vector<int> face_of = corner_faces(mesh);
  std::vector<EdgeMeeting> meetings;
  meetings.reserve(edges.edges.size());
  for (int e = 0; e < static_cast<int>(edges.edges.size()); ++e) {
    const auto [a, b] = edges.edge_sides[e];
    if (b >= 0) meetings.push_back({e, face_of[a], face_of[b], mesh.corner_vertices[a] == mesh.corner_vertices[b]});
  }
  return meetings;
}

}  // namespace

Polygons narrowed(GivenPolygons given) {
  return {std::move(given.vertices),
          {given.corner_vertices.begin(), given.corner_vertices.end()},
          {given.face_offsets.begin(), given.face_offsets.end()},
          {}};
}

void complete(Surface& surface, const MeshLabels& label, Execution& execution) {
  Workers& workers = execution.workers();
  const Polygons& mesh = surface.polygons;
  surface.vertex_count = static_cast<int>(mesh.vertices.size());
  PolygonEdges edges = polygon_edges(mesh, label, workers);
  surface.polygon_edge_count = static_cast<int>(edges.edges.size());
  const Orientation orientation =
      edges.oriented ? oriented_as_given(mesh, edges.edges)
                     : orient(static_cast<int>(mesh.face_offsets.size()) - 1, meetings_of(mesh, edges));
  const bool all_triangles = mesh.corner_vertices.size() == 3 * (mesh.face_offsets.size() - 1);
  const auto loop_of_vertex = all_triangles ? std::vector<int>{} : boundary_loop_of_vertex(edges, surface.vertex_count);
  surface.edges = std::move(edges.edges);
  record_orientation(surface, orientation, label);
  resize_arrays(surface);
  for_rows(workers, surface.polygon_edge_count,
           [&](int e) { surface.edge_face_count[e] = edges.edge_sides[e][1] < 0 ? 1 : 2; });
  cut_polygons(surface, edges, loop_of_vertex, orientation.reversed, workers);
  for_rows(workers, static_cast<int>(surface.edges.size()), [&](int e) {
    const auto [a, b] = surface.edges[e];
    surface.edge_lengths[e] = distance(mesh.vertices[a], mesh.vertices[b]);
  });
  edges = {};  // the half-edges take its pages
  finish_records(surface, execution, label);
}

Surface make_surface(Polygons polygons, Execution& execution) {
  check_polygons(polygons, execution.workers());
  Surface surface;
  surface.polygons = std::move(polygons);
  complete(surface, {}, execution);
  return surface;
}

Surface make_surface(GivenPolygons polygons, Execution& execution) {
  check_polygons(polygons, execution.workers());
  const FileRecord file = std::move(polygons.file);
  const auto numbers = [&](std::vector<int> index, std::size_t count) {
    if (file.first_number == 0 && index.empty()) return index;
    if (index.empty()) {
      index.resize(count);
      std::iota(index.begin(), index.end(), 0);
    }
    for (int& i : index) i += file.first_number;
    return index;
  };
  const std::vector<int> vertices = numbers({}, polygons.vertices.size());
  const std::vector<int> faces = numbers(file.face_index, polygons.face_offsets.size() - 1);
  Surface surface;
  surface.polygons = narrowed(std::move(polygons));
  complete(surface, {Labels(vertices), Labels(faces)}, execution);
  return surface;
}

}  // namespace holomorph::mesh
