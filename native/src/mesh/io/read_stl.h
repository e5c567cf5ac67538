// STL, text and binary; corners with equal coordinates are welded.
#pragma once

#include "mesh/io/file_text.h"

namespace holomorph::mesh {

/// Reads a file of the format STL. @throws InvalidMesh "name: reason"
GivenPolygons read_stl(const FileText& file);

}  // namespace holomorph::mesh
