#include "progressive/levels.h"

#include "progressive/refinement.h"

namespace holomorph::progressive {

using Faces = std::vector<Triple>;

mesh::Polygons level(const ProgressiveMesh& mesh, int splits) {
  Refinement refinement(mesh, splits);
  while (refinement.splits_made() < splits) refinement.split();
  return triangle_polygons({mesh.positions.begin(), mesh.positions.begin() + mesh.base_vertex_count() + splits},
                           refinement.triangles());
}

mesh::Polygons restored(const ProgressiveMesh& mesh) {
  Refinement refinement(mesh, static_cast<int>(mesh.splits.size()));
  while (refinement.splits_made() < static_cast<int>(mesh.splits.size())) refinement.split();
  const Faces triangles = refinement.triangles(), corners = original_corners(mesh);
  mesh::Polygons polygons;
  polygons.vertices.resize(mesh.positions.size());
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) polygons.vertices[mesh.vertex_index[v]] = mesh.positions[v];
  polygons.face_offsets.assign(mesh.face_offsets.begin(), mesh.face_offsets.end());
  // No offsets were stored: all polygons are triangles.
  for (int t = 0; mesh.face_offsets.empty() && t <= mesh.triangle_count(); ++t) polygons.face_offsets.push_back(3 * t);
  polygons.corner_vertices.resize(static_cast<std::size_t>(polygons.face_offsets.back()));
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) polygons.corner_vertices[corners[t][i]] = mesh.vertex_index[triangles[t][i]];
  }
  return polygons;
}

}  // namespace holomorph::progressive
