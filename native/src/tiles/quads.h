// The cells of a tiling as quads.
#pragma once

#include <span>
#include <vector>

#include "tiles/cells.h"

namespace holomorph::tiles {

/// The vertices of polygons that are needed, #V flags: those that are, and besides those by which sides with the same
/// ends differ, and those of polygons that would have fewer than three. @param offsets, corner_vertices as of Cells
std::vector<char> needed_vertices(std::span<const int> offsets, std::span<const int> corner_vertices,
                                  std::vector<char> is_needed);

/// Leaves out the other ones: a tile of four corners becomes a quad.
Cells simplified(const Cells& cells);

/// The same, with polygons of six, eight ... corners split into quads without another vertex, as fans from the corner
/// where the worst angle is nearest to a right one.
Cells in_quads(const mesh::Surface& surface, const Cells& cells);

}  // namespace holomorph::tiles
