#include "mesh/polygon_checks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "base/chunks.h"
#include "base/errors.h"

namespace holomorph::mesh {
namespace {

// Half-edges are numbered by int, two for each side of a triangle: this bound leaves room for all of them.
constexpr std::int64_t kMaxCorners = std::numeric_limits<int>::max() / 8;

using std::to_string;

void check_sizes(const Polygons& mesh) {
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
    const auto size = offsets[f + 1] - offsets[f];
    if (size < 0) throw InvalidMesh("face_offsets decrease at face " + to_string(f));
    if (size < 3)
      throw InvalidMesh("face " + to_string(f) + " has " + to_string(size) + " corners; it needs at least 3");
  }
}

bool is_finite(const std::array<double, 3>& point) {
  return std::isfinite(point[0]) && std::isfinite(point[1]) && std::isfinite(point[2]);
}

[[noreturn]] void refuse_vertex(const Polygons& mesh, int vertex) {
  for (const double x : mesh.vertices[vertex]) {
    if (!std::isfinite(x))
      throw InvalidMesh("vertex " + to_string(vertex) + " has a coordinate that is " +
                        (std::isnan(x) ? "not a number" : "infinite"));
  }
  throw Error("vertex " + to_string(vertex) + " is finite");
}

struct Corners {
  const std::int64_t *begin, *end;
};

Corners corners_of(const Polygons& mesh, int face) {
  return {mesh.corner_vertices.data() + mesh.face_offsets[face],
          mesh.corner_vertices.data() + mesh.face_offsets[face + 1]};
}

// A vertex that comes twice, or -1.
std::int64_t vertex_met_twice(Corners corners) {
  std::vector<std::int64_t> sorted(corners.begin, corners.end);
  std::sort(sorted.begin(), sorted.end());
  const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
  return twice == sorted.end() ? -1 : *twice;
}

bool is_sound(const Polygons& mesh, int face) {
  const auto vertex_count = static_cast<std::int64_t>(mesh.vertices.size());
  const Corners corners = corners_of(mesh, face);
  const auto in_range = [&](std::int64_t v) { return v >= 0 && v < vertex_count; };
  if (!std::all_of(corners.begin, corners.end, in_range)) return false;
  if (corners.end - corners.begin > 3) return vertex_met_twice(corners) < 0;
  const std::int64_t a = corners.begin[0], b = corners.begin[1], c = corners.begin[2];
  return a != b && b != c && c != a;
}

[[noreturn]] void refuse_face(const Polygons& mesh, int face) {
  const auto vertex_count = static_cast<std::int64_t>(mesh.vertices.size());
  const Corners corners = corners_of(mesh, face);
  for (const auto* corner = corners.begin; corner != corners.end; ++corner) {
    if (*corner < 0)
      throw InvalidMesh("face " + to_string(face) + " has the negative vertex index " + to_string(*corner));
    if (*corner >= vertex_count) {
      throw InvalidMesh("face " + to_string(face) + " names vertex " + to_string(*corner) + ", but there are only " +
                        to_string(vertex_count) + " vertices");
    }
  }
  throw InvalidMesh("face " + to_string(face) + " has vertex " + to_string(vertex_met_twice(corners)) + " twice");
}

}  // namespace

void check_polygons(const Polygons& mesh) {
  check_sizes(mesh);
  Workers workers;
  const int vertices = static_cast<int>(mesh.vertices.size()), faces = static_cast<int>(mesh.face_offsets.size()) - 1;
  const int bad_vertex = first_row(workers, vertices, [&](int v) { return !is_finite(mesh.vertices[v]); });
  if (bad_vertex < vertices) refuse_vertex(mesh, bad_vertex);
  const int bad_face = first_row(workers, faces, [&](int f) { return !is_sound(mesh, f); });
  if (bad_face < faces) refuse_face(mesh, bad_face);
}

}  // namespace holomorph::mesh
