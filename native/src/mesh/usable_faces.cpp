#include "mesh/usable_faces.h"

#include <algorithm>
#include <array>

#include "base/errors.h"
#include "mesh/polygon_checks.h"
#include "mesh/wild_vertices.h"

namespace holomorph::mesh {
namespace {

// Vertices that do not exist become -1.
template <class Index>
Polygons with_existing_vertices(BasicPolygons<Index> given) {
  Polygons mesh{std::move(given.vertices), {}, {given.face_offsets.begin(), given.face_offsets.end()}};
  mesh.corner_vertices.reserve(given.corner_vertices.size());
  const auto count = static_cast<Index>(mesh.vertices.size());
  for (const Index v : given.corner_vertices)
    mesh.corner_vertices.push_back(v >= 0 && v < count ? static_cast<int>(v) : -1);
  return mesh;
}

template <class Index>
bool has_one_of(const BasicPolygons<Index>& mesh, int face, const std::vector<int>& vertices) {
  const auto end = mesh.corner_vertices.begin() + mesh.face_offsets[face + 1];
  return std::any_of(mesh.corner_vertices.begin() + mesh.face_offsets[face], end, [&](Index v) {
    return std::binary_search(vertices.begin(), vertices.end(), static_cast<int>(v));
  });
}

std::string wild_text(const FileRecord& file, int vertex) {
  return "vertex " + file.vertex(vertex) + " is more than 1e9 times as far away as the mesh is large";
}

template <class Index>
void refuse_wild(const BasicPolygons<Index>& mesh) {
  const std::vector<int> wild = wild_vertices(mesh);
  if (!wild.empty()) throw InvalidMesh(wild_text(mesh.file, wild.front()));
}

template <class Index>
UsableFaces usable(BasicPolygons<Index> given) {
  std::array<RefusedFaces, 5> by_fault;  // those with wild vertices are the last
  const std::vector<int> wild = wild_vertices(given);
  if (!wild.empty()) by_fault.back().reason = wild_text(given.file, wild.front());
  std::vector<int> faces;
  for (int f = 0; f + 1 < static_cast<int>(given.face_offsets.size()); ++f) {
    const FaceFault fault = fault_of_face(given, f);
    RefusedFaces& refused = by_fault[static_cast<std::size_t>(fault)];
    if (fault != FaceFault::kNone && refused.faces.empty()) refused.reason = fault_text(given, f);
    const bool is_wild = !wild.empty() && fault == FaceFault::kNone && has_one_of(given, f, wild);
    (is_wild ? by_fault.back().faces : fault == FaceFault::kNone ? faces : refused.faces).push_back(f);
  }
  const Polygons mesh = with_existing_vertices(std::move(given));
  UsableFaces result{PolygonParts(mesh).take(std::move(faces)), {}};
  for (RefusedFaces& refused : by_fault) {
    if (!refused.faces.empty()) result.refused.push_back(std::move(refused));
  }
  return result;
}

}  // namespace

UsableFaces usable_faces(GivenPolygons polygons) { return usable(std::move(polygons)); }
UsableFaces usable_faces(Polygons polygons) { return usable(std::move(polygons)); }
void refuse_wild_vertices(const Polygons& polygons) { refuse_wild(polygons); }
void refuse_wild_vertices(const GivenPolygons& polygons) { refuse_wild(polygons); }

}  // namespace holomorph::mesh
