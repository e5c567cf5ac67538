// Checks of single polygons, before anything walks the mesh.
#pragma once

#include <string>

#include "base/workers.h"
#include "mesh/polygons.h"

namespace holomorph::mesh {

/// Refuses a mesh without faces, offsets that do not fit, too many elements for 32 bits. @throws InvalidMesh
void check_layout(const Polygons& polygons);
void check_layout(const GivenPolygons& polygons);

/// What keeps a face from being mapped, however the mesh is cut.
enum class FaceFault { kNone, kNoSuchVertex, kNotFinite, kFewVertices };

/// kNotFinite stands for coordinates beyond kLargest, too. @pre check_layout has passed
FaceFault fault_of_face(const Polygons& polygons, int face);
FaceFault fault_of_face(const GivenPolygons& polygons, int face);

/// Returns what `check_polygons` says about a face that it refuses.
std::string fault_text(const Polygons& polygons, int face);
std::string fault_text(const GivenPolygons& polygons, int face);

/// Refuses bad polygons, naming the first bad element. Faces: none at all, offsets that do not fit, fewer than 3
/// corners, a negative or too large index, a vertex twice. Positions: NaN, infinite or beyond kLargest, or all below
/// kSmallest. Also too many elements for 32 bits.
/// @throws InvalidMesh
void check_polygons(const Polygons& polygons, Workers& workers);
void check_polygons(const GivenPolygons& polygons, Workers& workers);

}  // namespace holomorph::mesh
