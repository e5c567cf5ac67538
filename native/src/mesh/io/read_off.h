// OFF: vertices and polygons.
#pragma once

#include "mesh/io/file_text.h"

namespace holomorph::mesh {

/// Reads a file of the format OFF. @throws InvalidMesh "name: reason"
GivenPolygons read_off(const FileText& file);

}  // namespace holomorph::mesh
