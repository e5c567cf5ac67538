// PLY, text and binary of both byte orders.
#pragma once

#include "mesh/io/file_text.h"

namespace holomorph::mesh {

/// @throws InvalidMesh "name: reason"
GivenPolygons read_ply(const FileText& file);

}  // namespace holomorph::mesh
