// Turns the coordinates of polygons until v runs up on most: each polygon of a turned map may be turned by itself.
#pragma once

#include <vector>

#include "tiling/cones/net.h"
#include "tiling/cones/scale_form.h"
#include "uv/uv_map.h"

namespace holomorph::tiling {

/// By how many k-th turns s the UVs of each polygon are to be turned. Minimises what is minded of the steep area that
/// does not stand upright, and the lengths of edges that turn, by r + s(right) - s(left), where they are smooth: as far
/// as single polygons and regions, turned as one, lower it.
/// @param in_plane #C x 2. @param turn #E, k-th turns of the map's jumps
/// @return #T, the same for all triangles of a polygon. Cost: linear, a few rounds
std::vector<int> upright_turns(const mesh::Surface& surface, const Net& net, const uv::UvArray& in_plane, int k,
                               const Along& along, const std::vector<int>& turn);

/// Part of the area over which v does not run up even if each triangle may be turned by itself: steep, by the square of
/// the sine. @param in_plane #C x 2
double off_level(const mesh::Surface& surface, const Net& net, const uv::UvArray& in_plane, int k, const Along& along);

}  // namespace holomorph::tiling
