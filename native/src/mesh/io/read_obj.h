// Wavefront OBJ: vertices and polygons; everything else is skipped.
#pragma once

#include "mesh/io/file_text.h"

namespace holomorph::mesh {

/// Reads a file of the format OBJ. @throws InvalidMesh "name: reason"
GivenPolygons read_obj(const FileText& file);

}  // namespace holomorph::mesh
