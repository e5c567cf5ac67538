// PLY, text and binary of both byte orders.
#pragma once

#include "mesh/io/scanner.h"

namespace holomorph::mesh {

/// Reads a file of the format PLY. @throws InvalidMesh "name: reason"
GivenPolygons read_ply(const FileText& file);

}  // namespace holomorph::mesh
