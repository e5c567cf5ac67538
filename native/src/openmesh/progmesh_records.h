// Progressive meshes and the records of OpenMesh's decimater (OpenMesh/Tools/Decimater/ModProgMeshT.hh), either way.
#pragma once

#include <OpenMesh/Core/Mesh/Handles.hh>
#include <vector>

#include "openmesh/surface_of_mesh.h"
#include "progressive/refinement.h"

namespace holomorph::openmesh {

/// One half-edge collapse v0 -> v1 with the fields of ModProgMeshT::Info, which only a collapse can make. v0 is
/// removed, v1 remains. vl and vr lie to the left and right of v0 -> v1, invalid where the edge is on the boundary. The
/// split {v_s, v_t, v_l, v_r} is the collapse {v0 = v_t, v1 = v_s, vl = v_r, vr = v_l}.
struct ProgMeshRecord {
  OpenMesh::VertexHandle v0, v1, vl, vr;
  friend bool operator==(const ProgMeshRecord&, const ProgMeshRecord&) = default;
};

/// Returns records as ModProgMeshT::infolist() has them, the first collapse first: vertex splits take them from the
/// end. Handles are the numbers of the progressive mesh, which are those of OpenMesh's .pm files: the base first, then
/// v0 of each split. A TriMesh with the vertices of the base is refined by
///   mesh.vertex_split(mesh.add_vertex(position of v0), r.v1, r.vl, r.vr)
/// Records have no place for the corners of triangles, so slots, polygons and corner data stay behind.
std::vector<ProgMeshRecord> to_progmesh_records(const progressive::ProgressiveMesh& mesh);

namespace detail {
/// @param base triangles that are left, by the mesh's handles. @param positions #V of the mesh
progressive::ProgressiveMesh from_records(const std::vector<mesh::Triple>& base,
                                          const std::vector<std::array<double, 3>>& positions,
                                          const std::vector<ProgMeshRecord>& records);
}  // namespace detail

/// Makes the progressive mesh of a decimated TriMesh, before its garbage collection. The finest level has the vertices
/// and triangles of the mesh before it was decimated; `vertex_index` has the handle of each vertex. The records do not
/// say which triangles were which. So these are numbered in the order of the splits. v_s comes first in the new left
/// triangle, v_t in the right one.
/// @param records a range of ModProgMeshT::Info or ProgMeshRecord, as infolist() has them
/// @throws InvalidMesh for faces that are not triangles, vertices that are isolated or that no record deletes, and
/// records that do not fit
template <class Mesh, class Records>
progressive::ProgressiveMesh from_progmesh_records(const Mesh& mesh, const Records& records) {
  SurfaceOfMesh part;
  mesh::Polygons polygons;
  for (int f = 0; f < static_cast<int>(mesh.n_faces()); ++f) {
    if (!is_deleted(mesh, OpenMesh::FaceHandle(f))) detail::append_face(mesh, OpenMesh::FaceHandle(f), part, polygons);
  }
  std::vector<mesh::Triple> base;
  for (std::size_t f = 0; f < part.faces.size(); ++f) {
    if (polygons.face_offsets[f] != 3 * (static_cast<int>(f) + 1)) {
      throw InvalidMesh("face " + std::to_string(part.faces[f].idx()) + " is not a triangle");
    }
    const int* v = &polygons.corner_vertices[3 * f];
    base.push_back({v[0], v[1], v[2]});
  }
  std::vector<std::array<double, 3>> positions;
  for (int v = 0; v < static_cast<int>(mesh.n_vertices()); ++v) {
    const auto& p = mesh.point(OpenMesh::VertexHandle(v));
    positions.push_back({static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])});
  }
  std::vector<ProgMeshRecord> list;
  for (const auto& record : records) list.push_back({record.v0, record.v1, record.vl, record.vr});
  return detail::from_records(base, positions, list);
}

}  // namespace holomorph::openmesh
