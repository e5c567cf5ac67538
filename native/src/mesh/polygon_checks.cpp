#include "mesh/polygon_checks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string>

#include "base/chunks.h"
#include "base/errors.h"
#include "mesh/triangle_geometry.h"

namespace holomorph::mesh {
namespace {

// Half-edges are numbered by int, two for each side of a triangle: this bound keeps them in range.
constexpr std::int64_t kMaxCorners = std::numeric_limits<int>::max() / 8;

using std::to_string;

template <class Index>
void check_arrays(const BasicPolygons<Index>& mesh) {
  const auto corners = static_cast<std::int64_t>(mesh.corner_vertices.size());
  const auto& offsets = mesh.face_offsets;
  if (offsets.size() < 2) throw InvalidMesh("the mesh has no faces");
  if (corners > kMaxCorners || static_cast<std::int64_t>(mesh.vertices.size()) > kMaxCorners) {
    throw InvalidMesh("the mesh has more than " + to_string(kMaxCorners) +
                      " corners or vertices, too many for 32-bit indices");
  }
  if (offsets.front() != 0 || offsets.back() != corners) {
    throw InvalidMesh("face_offsets must run from 0 to the number of corners " + to_string(corners) + ", not from " +
                      to_string(offsets.front()) + " to " + to_string(offsets.back()));
  }
  for (std::size_t f = 0; f + 1 < offsets.size(); ++f) {
    if (offsets[f + 1] < offsets[f]) throw InvalidMesh("face_offsets decrease at face " + to_string(f));
  }
}

double largest_coordinate(const std::array<double, 3>& point) {
  return std::max({std::abs(point[0]), std::abs(point[1]), std::abs(point[2])});
}

bool is_usable(const std::array<double, 3>& point) {  // NaN: no comparison holds
  return std::abs(point[0]) <= kLargest && std::abs(point[1]) <= kLargest && std::abs(point[2]) <= kLargest;
}

template <class Index>
std::string fault_of_vertex(const BasicPolygons<Index>& mesh, std::int64_t vertex) {
  const std::array<double, 3>& point = mesh.vertices[static_cast<std::size_t>(vertex)];
  const std::string name = "vertex " + mesh.file.vertex(vertex);
  for (const double x : point) {
    if (!std::isfinite(x)) {
      return name + " has a coordinate that is " + (std::isnan(x) ? "not a number" : "infinite");
    }
  }
  return is_usable(point) ? "" : name + " has a coordinate beyond 1e60: scale the mesh down";
}

template <class Index>
std::span<const Index> corners_of(const BasicPolygons<Index>& mesh, int face) {
  return {mesh.corner_vertices.data() + mesh.face_offsets[face],
          mesh.corner_vertices.data() + mesh.face_offsets[face + 1]};
}

template <class Index>
bool are_vertices(const BasicPolygons<Index>& mesh, std::span<const Index> corners) {
  const auto count = static_cast<Index>(mesh.vertices.size());
  return std::all_of(corners.begin(), corners.end(), [&](Index v) { return v >= 0 && v < count; });
}

template <class Index>
bool has_three_vertices(std::span<const Index> corners) {
  const Index a = corners.empty() ? Index(-1) : corners[0];
  const auto b = std::find_if(corners.begin(), corners.end(), [&](Index v) { return v != a; });
  return std::any_of(b, corners.end(), [&](Index v) { return v != a && v != *b; });
}

template <class Index>
FaceFault fault_kind(const BasicPolygons<Index>& mesh, int face) {
  const auto corners = corners_of(mesh, face);
  if (!are_vertices(mesh, corners)) return FaceFault::kNoSuchVertex;
  const auto is_finite = [&](Index v) { return is_usable(mesh.vertices[v]); };
  if (!std::all_of(corners.begin(), corners.end(), is_finite)) return FaceFault::kNotFinite;
  return has_three_vertices(corners) ? FaceFault::kNone : FaceFault::kFewVertices;
}

// A vertex that occurs twice, or -1.
template <class Index>
Index vertex_met_twice(std::span<const Index> corners) {
  std::vector<Index> sorted(corners.begin(), corners.end());
  std::sort(sorted.begin(), sorted.end());
  const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
  return twice == sorted.end() ? -1 : *twice;
}

template <class Index>
bool is_sound(const BasicPolygons<Index>& mesh, int face) {
  const auto corners = corners_of(mesh, face);
  if (corners.size() < 3 || !are_vertices(mesh, corners)) return false;
  if (corners.size() > 3) return vertex_met_twice(corners) < 0;
  const Index a = corners[0], b = corners[1], c = corners[2];
  return a != b && b != c && c != a;
}

template <class Index>
std::string fault_of(const BasicPolygons<Index>& mesh, int face) {
  const auto vertex_count = static_cast<Index>(mesh.vertices.size());
  const auto corners = corners_of(mesh, face);
  const std::string name = "face " + mesh.file.face(face);
  if (corners.size() < 3) return name + " has " + to_string(corners.size()) + " corners; it needs at least 3";
  for (const Index v : corners) {
    if (v < 0) return name + " has the negative vertex index " + mesh.file.vertex(v);
    if (v >= vertex_count) {
      return name + " names vertex " + mesh.file.vertex(v) + "; numbers from " + mesh.file.vertex(0) + " to below " +
             mesh.file.vertex(vertex_count) + " are needed";
    }
  }
  for (const Index v : corners) {
    if (!is_usable(mesh.vertices[v])) return fault_of_vertex(mesh, v);
  }
  const Index v = vertex_met_twice(corners);
  return v >= 0 ? name + " has vertex " + mesh.file.vertex(v) + " twice" : "";
}

template <class Index>
void check(const BasicPolygons<Index>& mesh, Workers& workers) {
  check_arrays(mesh);
  const int vertices = static_cast<int>(mesh.vertices.size()), faces = static_cast<int>(mesh.face_offsets.size()) - 1;
  const int bad_vertex = first_row(workers, vertices, [&](int v) { return !is_usable(mesh.vertices[v]); });
  if (bad_vertex < vertices) throw InvalidMesh(fault_of_vertex(mesh, bad_vertex));
  const auto is_above = [&](double least) {
    return first_row(workers, vertices, [&](int v) { return largest_coordinate(mesh.vertices[v]) > least; }) < vertices;
  };
  if (!is_above(kSmallest) && is_above(0)) throw InvalidMesh("all coordinates are below 1e-60: scale the mesh up");
  const int bad_face = first_row(workers, faces, [&](int f) { return !is_sound(mesh, f); });
  if (bad_face < faces) throw InvalidMesh(fault_of(mesh, bad_face));
}

}  // namespace

void check_layout(const Polygons& mesh) { check_arrays(mesh); }
void check_layout(const GivenPolygons& mesh) { check_arrays(mesh); }
FaceFault fault_of_face(const Polygons& mesh, int face) { return fault_kind(mesh, face); }
FaceFault fault_of_face(const GivenPolygons& mesh, int face) { return fault_kind(mesh, face); }
std::string fault_text(const Polygons& mesh, int face) { return fault_of(mesh, face); }
std::string fault_text(const GivenPolygons& mesh, int face) { return fault_of(mesh, face); }
void check_polygons(const Polygons& mesh, Workers& workers) { check(mesh, workers); }
void check_polygons(const GivenPolygons& mesh, Workers& workers) { check(mesh, workers); }

}  // namespace holomorph::mesh
