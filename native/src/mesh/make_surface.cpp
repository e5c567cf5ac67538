#include "mesh/make_surface.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "base/chunks.h"
#include "mesh/orientation.h"
#include "mesh/polygon_checks.h"
#include "mesh/polygon_edges.h"
#include "mesh/surface_records.h"
#include "mesh/triangle_geometry.h"
#include "mesh/triangulation.h"

namespace holomorph::mesh {
namespace {

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
