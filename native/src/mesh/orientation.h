// A consistent orientation of the polygons, and their connected components.
#pragma once

#include <vector>

#include "base/execution.h"
#include "mesh/surface.h"

namespace holomorph::mesh {

struct Orientation {
  std::vector<char> reversed;  ///< #F 1 where the polygon must be read in reverse
  Array<int> face_component;   ///< #F, numbered by first polygon
  int component_count = 0;
  int conflict = -1;  ///< an edge at which no orientation fits; -1 if the mesh is orientable
};

/// Two faces that meet at an edge; one of them is reversed if both run along it in the same direction.
struct EdgeMeeting {
  int edge, face, other_face;
  bool same_direction;
};

/// Orients each component as the majority of its faces is given; if there is none, as its first face.
Orientation orient(int face_count, const std::vector<EdgeMeeting>& meetings);

/// Finds the components of a mesh in which no face has to be reversed, from the vertices: in such a mesh, faces that
/// share a vertex belong to one component.
/// @param edges #E ends, lower first
Orientation oriented_as_given(const Polygons& polygons, const Array<Pair>& edges);

/// Records components and reversed faces. @throws TopologyError naming the edge at which no orientation fits
void record_orientation(Surface& surface, const Orientation& orientation, const MeshLabels& label = {});

/// Records isolated vertices and faces without area. Refuses non-manifold vertices and a surface without area.
/// @throws InvalidMesh
void finish_records(Surface& surface, Execution& execution, const MeshLabels& label = {});

}  // namespace holomorph::mesh
