// Where vertices are joined: at sides of faces that lie on each other. Decided here, for every file and application.
#pragma once

#include <array>
#include <vector>

#include "mesh/stitching.h"
#include "mesh/surface.h"

namespace holomorph::mesh {

/// The distance below which points of a mesh are at one place: a millionth of its median side, as copies of a vertex
/// that were computed apart differ by less. Not below the rounding of its largest coordinate. @pre finite coordinates
double spacing(const Polygons& mesh);

/// #V the first vertex at the same place, by coordinates rounded to multiples of the spacing. @pre finite coordinates
std::vector<int> first_at_place(const std::vector<std::array<double, 3>>& vertices, double spacing);

/// #V the vertex that each one becomes where a side without a neighbour runs from one to another at the same place, as
/// at the poles of a sphere that is written as a grid. @pre finite coordinates
std::vector<int> without_point_sides(const Polygons& mesh);

/// What `merge_repeated_corners` takes away, by the given indices.
struct RepeatedCorners {
  std::vector<int> faces;     ///< with fewer than three corners left
  std::vector<Pair> corners;  ///< of other faces, each with the one of its face that stands for it
};

/// Corners of a face that follow one another at the same vertex become one: a corner goes where the one before it has
/// its vertex. Faces that had three corners and have fewer now go, too; the faces beside them meet where they were.
/// @param face_index, corner_index #F, #C indices, kept in step with the mesh
RepeatedCorners merge_repeated_corners(Polygons& mesh, std::vector<int>& face_index, std::vector<int>& corner_index);
RepeatedCorners merge_repeated_corners(GivenPolygons& mesh, std::vector<int>& face_index,
                                       std::vector<int>& corner_index);

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
