// Where vertices are joined: at sides of faces that lie on each other. Decided here, for every file and application.
#pragma once

#include <array>
#include <vector>

#include "mesh/corner_labels.h"
#include "mesh/polygons.h"
#include "mesh/stitching.h"
#include "mesh/surface.h"

namespace holomorph::mesh {

/// #V the first vertex at the same place, by coordinates rounded to single precision. So copies of one vertex are found
/// again after they went through a file or a matrix. @pre finite coordinates
std::vector<int> first_at_place(const std::vector<std::array<double, 3>>& vertices);

/// Whether vertices of the boundary lie on each other.
bool meets_itself(const Surface& surface);

/// Which faces are apart from all others, and how the sides of the rest are joined.
struct Plan {
  CornerLabels labels;
  SideJoins joins;
};

/// Plans how a mesh becomes a surface. Sides without a neighbour are joined where just two of them run between the same
/// places in opposite directions, and no edge gets more than two faces by it: as along the seams of a UV map in glTF
/// files. Faces that lie back to back stay two, and parts that touch in a point stay apart. Where most sides have no
/// neighbour, as in files that give each face vertices of its own, all are joined whose vertices lie on each other, if
/// that leaves less than half of them alone.
/// @pre finite coordinates
/// Cost: O(#C log #C), times a few where joined vertices are taken apart again.
Plan welded_plan(const Polygons& mesh);

}  // namespace holomorph::mesh
