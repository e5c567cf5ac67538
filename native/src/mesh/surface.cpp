#include "mesh/surface.h"

#include <algorithm>
#include <map>

#include "mesh/orientation.h"
#include "mesh/polygon_checks.h"
#include "mesh/polygon_edges.h"
#include "mesh/surface_records.h"
#include "mesh/triangle_geometry.h"
#include "mesh/triangulation.h"

namespace holomorph::mesh {
namespace {

// Appends the triangles of one polygon; diagonals get new edges, each known to its two triangles only.
class PolygonCutter {
 public:
  PolygonCutter(Surface& surface, const PolygonEdges& edges, std::vector<int> loop_of_vertex)
      : surface_(surface), edges_(edges), loop_of_vertex_(std::move(loop_of_vertex)) {}

  void cut(int face, bool reversed) {
    const auto& mesh = surface_.polygons;
    const int first = static_cast<int>(mesh.face_offsets[face]);
    const int n = static_cast<int>(mesh.face_offsets[face + 1]) - first;
    if (n == 3) return add(face, reversed, first, {0, 1, 2}, 3);
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
    const auto [known, is_new] = diagonals_.try_emplace(Pair{i, j}, static_cast<int>(surface_.edges.size()));
    if (!is_new) return known->second;
    const auto a = static_cast<int>(surface_.polygons.corner_vertices[first + i]);
    const auto b = static_cast<int>(surface_.polygons.corner_vertices[first + j]);
    surface_.edges.push_back({std::min(a, b), std::max(a, b)});
    return known->second;
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
    for (int c = 0; c < 3; ++c) vertices[c] = static_cast<int>(surface_.polygons.corner_vertices[corners[c]]);
    surface_.triangles.push_back(vertices);
    surface_.triangle_corners.push_back(corners);
    surface_.triangle_edges.push_back(sides);
    surface_.triangle_faces.push_back(face);
  }

  Surface& surface_;
  const PolygonEdges& edges_;
  std::vector<int> loop_of_vertex_;  // #V, -1 in the interior
  std::vector<std::array<double, 3>> points_;
  std::vector<int> loops_;         // of the polygon being cut
  std::map<Pair, int> diagonals_;  // of the polygon being cut, by its local corners
};

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

Surface make_surface(Polygons polygons) {
  check_polygons(polygons);
  Surface surface;
  surface.polygons = std::move(polygons);
  const Polygons& mesh = surface.polygons;
  surface.vertex_count = static_cast<int>(mesh.vertices.size());
  PolygonEdges edges = polygon_edges(mesh);
  const int face_count = static_cast<int>(mesh.face_offsets.size()) - 1;
  surface.polygon_edge_count = static_cast<int>(edges.edges.size());
  const Orientation orientation = orient(face_count, meetings_of(mesh, edges));
  std::vector<int> loop_of_vertex = boundary_loop_of_vertex(edges, surface.vertex_count);
  surface.edges = std::move(edges.edges);
  record_orientation(surface, orientation);
  const std::size_t triangle_count = mesh.corner_vertices.size() - 2 * static_cast<std::size_t>(face_count);
  surface.triangles.reserve(triangle_count);
  surface.triangle_corners.reserve(triangle_count);
  surface.triangle_edges.reserve(triangle_count);
  surface.triangle_faces.reserve(triangle_count);
  PolygonCutter cutter(surface, edges, std::move(loop_of_vertex));
  for (int f = 0; f < face_count; ++f) cutter.cut(f, orientation.reversed[f]);
  surface.edge_lengths.reserve(surface.edges.size());
  for (const auto& [a, b] : surface.edges) surface.edge_lengths.push_back(distance(mesh.vertices[a], mesh.vertices[b]));
  finish_records(surface);
  return surface;
}

double area(const Surface& surface) {
  double sum = 0;
  for (const auto& [a, b, c] : surface.triangle_edges) {
    const auto& l = surface.edge_lengths;
    sum += triangle_area(l[a], l[b], l[c]);
  }
  return sum;
}

}  // namespace holomorph::mesh
