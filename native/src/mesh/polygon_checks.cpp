#include "mesh/polygon_checks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

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

void check_positions(const Polygons& mesh) {
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    for (const double x : mesh.vertices[v]) {
      if (!std::isfinite(x))
        throw InvalidMesh("vertex " + to_string(v) + " has a coordinate that is " +
                          (std::isnan(x) ? "not a number" : "infinite"));
    }
  }
}

// Indices into `sorted` are scratch, kept between polygons so that no polygon allocates.
void check_face(const Polygons& mesh, std::size_t face, std::vector<std::int64_t>& sorted) {
  const auto vertex_count = static_cast<std::int64_t>(mesh.vertices.size());
  const auto begin = mesh.corner_vertices.begin() + mesh.face_offsets[face];
  const auto end = mesh.corner_vertices.begin() + mesh.face_offsets[face + 1];
  for (auto corner = begin; corner != end; ++corner) {
    if (*corner < 0)
      throw InvalidMesh("face " + to_string(face) + " has the negative vertex index " + to_string(*corner));
    if (*corner >= vertex_count) {
      throw InvalidMesh("face " + to_string(face) + " names vertex " + to_string(*corner) + ", but there are only " +
                        to_string(vertex_count) + " vertices");
    }
  }
  sorted.assign(begin, end);
  std::sort(sorted.begin(), sorted.end());
  const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
  if (twice != sorted.end())
    throw InvalidMesh("face " + to_string(face) + " has vertex " + to_string(*twice) + " twice");
}

}  // namespace

void check_polygons(const Polygons& mesh) {
  check_sizes(mesh);
  check_positions(mesh);
  std::vector<std::int64_t> sorted;
  for (std::size_t f = 0; f + 1 < mesh.face_offsets.size(); ++f) check_face(mesh, f, sorted);
}

}  // namespace holomorph::mesh
