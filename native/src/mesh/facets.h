// Facets, the wide flat places of a surface. A bevel or a rounded edge between two of them is one hard edge, however
// little each of its own edges bends.
#pragma once

#include <vector>

#include "mesh/surface.h"

namespace holomorph::mesh {

/// Radians by which the surface breaks off at each edge, #E: the bend of its two polygons, or the angle between the
/// facets to both sides, if that is more. Strips between facets are part of that to which they bend less: a bevel is
/// one line. @pre the surface has positions Source: ours; the limits were chosen on pictures of bevelled props beside
/// smooth and coarse meshes.
std::vector<double> breaks(const Surface& surface);

}  // namespace holomorph::mesh
