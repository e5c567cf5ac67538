// What lies on the two sides of each edge.
#pragma once

#include <vector>

#include "mesh/surface.h"

namespace holomorph::mesh {

/// The sides of triangles at each edge, #E, ascending: side i of triangle t is 3 t + i. The second is -1 on the
/// boundary.
std::vector<Pair> edge_sides(const Surface& surface);

/// The polygons of these, #E: the same one twice at a diagonal.
std::vector<Pair> edge_faces(const Surface& surface);

}  // namespace holomorph::mesh
