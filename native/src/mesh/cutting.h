// Cutting any polygon mesh until it is a surface.
#pragma once

#include <vector>

#include "base/execution.h"
#include "mesh/cut_records.h"
#include "mesh/surface.h"
#include "mesh/usable_faces.h"

namespace holomorph::mesh {

/// A mesh cut along edges and at vertices: polygons and their corners are those given, in their order.
struct CutSurface {
  Surface surface;
  /// Index of each element in the mesh as given; all empty where that is its own. Vertices ascend. Copies of one vertex
  /// all have its index, and a vertex joined from several has the lowest of theirs.
  std::vector<int> vertex_index, face_index, corner_index;
  int given_vertex_count = 0;
  std::vector<Cut> cuts;              ///< by reasons
  std::vector<int> joined_vertices;   ///< given vertices that became one with a lower one at the same place
  std::vector<RefusedFaces> refused;  ///< faces that are left out, by reasons
};

/// Makes a surface as `make_surface` does, but cuts a mesh that `make_surface` refuses: each fan of faces gets its
/// own vertex. Leaves out faces with fewer than three vertices, with coordinates that are not finite or with wild
/// vertices, and parts without area.
///
/// Where most sides of faces have no neighbour, sides that run between the same places in opposite directions are
/// joined first. This is done if it gives most of them a neighbour.
/// @throws InvalidMesh where no face is left
/// Cost: linear for a surface; else O(#C log #C).
CutSurface cut_surface(Polygons polygons, Execution& execution);
CutSurface cut_surface(GivenPolygons polygons, Execution& execution);

}  // namespace holomorph::mesh
