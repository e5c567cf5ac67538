// STL, text and binary; corners with equal coordinates are welded.
#pragma once

#include "mesh/io/scanner.h"
#include "mesh/surface.h"

namespace holomorph::mesh {

// Vertices at the same place become one.

/// Vertices with equal coordinates (-0 equals 0) become the first of them, in order of first appearance in the faces.
/// Where corners of a face then follow one another with the same vertex, one is left. A face with fewer than three is
/// left out: the faces beside it meet where it was, and the record of the file tells where the others stood in it. A
/// mesh whose faces name vertices that do not exist stays as it is, for its validation to refuse.
GivenPolygons welded(const GivenPolygons& mesh);

/// Reads a file of the format STL. @throws InvalidMesh "name: reason"
GivenPolygons read_stl(const FileText& file);

}  // namespace holomorph::mesh
