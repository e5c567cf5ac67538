// Polygon meshes from files, in double precision, with every polygon, vertex and order as the file has them.
#pragma once

#include <filesystem>

#include "mesh/surface.h"

namespace holomorph::mesh {

/// Reads the polygons of an OBJ, OFF, PLY or STL file; the extension decides, in upper or lower case.
/// OBJ: `v` and `f` lines, negative indices, continued lines; other lines are skipped.
/// OFF: text, with normals, colours or texture coordinates skipped; 4D, nD and binary OFF are refused.
/// PLY: text and binary of either byte order; elements and properties that are not polygons or positions are skipped.
/// STL: text and binary; corners are welded (read_stl.h).
/// Accepts indices beyond the vertices, coordinates that are not finite and faces with fewer than 3 corners: the
/// validation of the mesh names these.
/// @throws InvalidMesh if the file cannot be read or is malformed; the sentence names file and line, byte or element.
/// Cost: linear in the file's size, which is kept in memory.
GivenPolygons read(const std::filesystem::path& path);

}  // namespace holomorph::mesh
