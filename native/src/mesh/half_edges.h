// Half-edges of a surface of triangles, built and walked by edge index: two edges may share both ends, and doubles and
// intrinsic surfaces have such edges, and loops.
#pragma once

#include "base/progress.h"
#include "mesh/half_edge_links.h"
#include "mesh/surface.h"

namespace holomorph::mesh {

/// @throws InvalidMesh for a vertex at which two fans of faces touch on the boundary
/// Cost: linear, in parallel.
HalfEdges half_edges(const Surface& surface, Progress& progress);

/// @throws InvalidMesh for the first vertex at which two fans of faces touch
void refuse_pinched_vertices(const HalfEdges& mesh);

/// +1 where `h` runs along its edge, -1 where it runs back.
inline int sign(HalfedgeHandle h) { return h.idx() & 1 ? -1 : 1; }
inline int edge_of(HalfedgeHandle h) { return h.idx() >> 1; }
inline HalfedgeHandle opposite(HalfedgeHandle h) { return HalfedgeHandle(h.idx() ^ 1); }
inline int from_vertex(const HalfEdges& mesh, HalfedgeHandle h) { return mesh.to_vertex_handle(opposite(h)).idx(); }
inline int to_vertex(const HalfEdges& mesh, HalfedgeHandle h) { return mesh.to_vertex_handle(h).idx(); }
inline int face_of(const HalfEdges& mesh, HalfedgeHandle h) { return mesh.face_handle(h).idx(); }
/// The next half-edge around the face, and the one after it, which is the one before.
inline HalfedgeHandle next(const HalfEdges& mesh, HalfedgeHandle h) { return mesh.next_halfedge_handle(h); }
/// Whether `h`, which has a face, is the one of lowest number there: every face has one such.
inline bool is_first_of_face(const HalfEdges& mesh, HalfedgeHandle h) {
  const HalfedgeHandle after = next(mesh, h);
  return h < after && h < next(mesh, after);
}

/// Turns edge e inside the quadrilateral of its two triangles, links only. @pre two different faces at e.
/// Threads may turn edges of different faces.
void flip_links(HalfEdges& mesh, EdgeHandle e);

/// Number of boundary loops.
int boundary_count(const HalfEdges& mesh);

}  // namespace holomorph::mesh
