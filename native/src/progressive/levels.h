// The levels of a progressive mesh, rebuilt split by split.
#pragma once

#include "progressive/progressive_mesh.h"

namespace holomorph::progressive {

/// Returns a level as polygons, in the numbering of the progressive mesh. @param splits from 0 to all
mesh::Polygons level(const ProgressiveMesh& mesh, int splits);

/// Returns the original polygons, bit for bit, rebuilt from the base by all the splits.
mesh::Polygons restored(const ProgressiveMesh& mesh);

}  // namespace holomorph::progressive
