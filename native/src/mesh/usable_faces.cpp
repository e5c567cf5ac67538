#include "mesh/usable_faces.h"

#include <array>

#include "mesh/polygon_checks.h"

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
UsableFaces usable(BasicPolygons<Index> given) {
  std::array<RefusedFaces, 4> by_fault;
  std::vector<int> faces;
  for (int f = 0; f + 1 < static_cast<int>(given.face_offsets.size()); ++f) {
    const FaceFault fault = fault_of_face(given, f);
    RefusedFaces& refused = by_fault[static_cast<std::size_t>(fault)];
    if (fault != FaceFault::kNone && refused.faces.empty()) refused.reason = fault_text(given, f);
    (fault == FaceFault::kNone ? faces : refused.faces).push_back(f);
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

}  // namespace holomorph::mesh
