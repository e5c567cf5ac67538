// The vertical plane in which a surface mirrors itself exactly, as figures and props do that were modelled so.
#pragma once

#include <optional>
#include <vector>

#include "mesh/surface.h"

namespace holomorph::mesh {

struct Mirror {
  std::vector<int> vertices;   ///< #V the vertex on the other side
  std::vector<int> corners;    ///< #C the corner of a polygon there
  std::vector<char> on_plane;  ///< #V
  std::vector<char> half;      ///< #F the polygons on one side
};

/// Finds the mirror of a surface in a plane between x and -x, or y, or z, whichever are not up, through the middle of
/// its box. None where there is none, polygons lie across it, no vertex lies in it, or the surface has no positions.
/// @param up index of the axis that points up. Cost: O(#C log #C)
std::optional<Mirror> mirror(const Surface& surface, int up);

}  // namespace holomorph::mesh
