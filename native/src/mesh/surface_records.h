// Records and checks that both kinds of surface share, once triangles and edges are known.
#pragma once

#include "base/execution.h"
#include "mesh/element_labels.h"
#include "mesh/orientation.h"
#include "mesh/surface.h"

namespace holomorph::mesh {

/// Records components and reversed faces. @throws TopologyError naming the edge at which no orientation fits
void record_orientation(Surface& surface, const Orientation& orientation, const MeshLabels& label = {});

/// Records isolated vertices and faces without area. Refuses non-manifold vertices and a surface without area.
/// @throws InvalidMesh
void finish_records(Surface& surface, Execution& execution, const MeshLabels& label = {});

}  // namespace holomorph::mesh
