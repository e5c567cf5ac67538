// What of a polygon mesh is a surface, where not all of it is.
#pragma once

#include <string>
#include <vector>

#include "base/execution.h"
#include "mesh/surface.h"

namespace holomorph::mesh {

/// A connected component that is no surface.
struct RefusedComponent {
  std::vector<int> faces;  ///< ascending
  std::string reason;      ///< names its first bad element
};

struct SoundPart {
  Surface surface;
  /// Index of each element in the mesh as given; all empty where that is its own.
  std::vector<int> vertex_index, face_index, corner_index;
  int given_vertex_count = 0;
  std::vector<int> split_vertices;  ///< vertices as given that are several, ascending
  std::vector<RefusedComponent> refused;
};

/// As `make_surface`; but where that refuses the mesh, fans of faces that touch at a vertex alone each get a vertex of
/// their own, and of the components, which faces form across edges, those that are refused are left out.
/// @throws what `make_surface` throws for the whole mesh where no component is left
SoundPart sound_part(Polygons polygons, Execution& execution);
SoundPart sound_part(GivenPolygons polygons, Execution& execution);

}  // namespace holomorph::mesh
