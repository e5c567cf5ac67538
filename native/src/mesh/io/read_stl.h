// STL, text and binary; corners with equal coordinates are welded.
#pragma once

#include "mesh/io/scanner.h"

namespace holomorph::mesh {

/// Reads a file of the format STL. @throws InvalidMesh "name: reason"
GivenPolygons read_stl(const FileText& file);

}  // namespace holomorph::mesh
