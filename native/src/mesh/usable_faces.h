// The faces of a polygon mesh that can be mapped.
#pragma once

#include <string>
#include <vector>

#include "mesh/polygon_parts.h"
#include "mesh/polygons.h"

namespace holomorph::mesh {

/// Faces that are left out for one reason.
struct RefusedFaces {
  std::vector<int> faces;  ///< ascending
  std::string reason;      ///< names the first bad element
};

struct UsableFaces {
  PolygonPart part;
  std::vector<RefusedFaces> refused;  ///< the others, by reasons
};

/// Keeps the faces with at least three different vertices, all of which exist and have finite coordinates, none of them
/// wild (wild_vertices).
/// @pre check_layout has passed
UsableFaces usable_faces(GivenPolygons polygons);
UsableFaces usable_faces(Polygons polygons);

/// Refuses a mesh with a wild vertex, naming the first. @throws InvalidMesh
void refuse_wild_vertices(const Polygons& polygons);
void refuse_wild_vertices(const GivenPolygons& polygons);

}  // namespace holomorph::mesh
