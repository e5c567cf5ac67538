// The half-edge mesh (OpenMesh's connectivity kernel), built and walked by edge index.
//
// OpenMesh's own add_face and flip look edges up by their ends, or assert on that; doubles and intrinsic surfaces have
// several edges between two vertices, and loops. So the kernel is filled link by link, and flipped here.
#pragma once

#include <OpenMesh/Core/Mesh/TriConnectivity.hh>
#include <vector>

#include "base/progress.h"
#include "mesh/surface.h"

namespace holomorph::mesh {

/// Half-edge 2e runs along edge e from its lower to its higher vertex, 2e+1 back; after a flip 2e is still the
/// direction in which a value on e is meant. Triangle t's first half-edge is its side 0.
using HalfEdges = OpenMesh::TriConnectivity;
using OpenMesh::EdgeHandle;
using OpenMesh::FaceHandle;
using OpenMesh::HalfedgeHandle;
using OpenMesh::VertexHandle;

/// @throws InvalidMesh for a vertex at which two fans of faces touch
HalfEdges half_edges(const Surface& surface, Progress& progress);

/// +1 where `h` runs along its edge, -1 where it runs back.
inline int sign(HalfedgeHandle h) { return h.idx() & 1 ? -1 : 1; }
inline int edge_of(HalfedgeHandle h) { return h.idx() >> 1; }
inline HalfedgeHandle opposite(HalfedgeHandle h) { return HalfedgeHandle(h.idx() ^ 1); }
inline int from_vertex(const HalfEdges& mesh, HalfedgeHandle h) { return mesh.to_vertex_handle(opposite(h)).idx(); }
inline int to_vertex(const HalfEdges& mesh, HalfedgeHandle h) { return mesh.to_vertex_handle(h).idx(); }
inline int face_of(const HalfEdges& mesh, HalfedgeHandle h) { return mesh.face_handle(h).idx(); }
/// The next half-edge around the face, and the one after it, which is the one before.
inline HalfedgeHandle next(const HalfEdges& mesh, HalfedgeHandle h) { return mesh.next_halfedge_handle(h); }

/// Turns edge e inside the quadrilateral of its two triangles, links only. @pre two different faces at e.
void flip_links(HalfEdges& mesh, EdgeHandle e);

/// Number of boundary loops.
int boundary_count(const HalfEdges& mesh);

}  // namespace holomorph::mesh
