// What was cut of a polygon mesh, and why.
#pragma once

#include <vector>

#include "mesh/corner_labels.h"
#include "mesh/polygon_parts.h"
#include "mesh/side_joins.h"
#include "mesh/surface.h"

namespace holomorph::mesh {

/// Why a mesh was cut.
enum class CutReason {
  kManyFaces,  ///< edges with three or more faces
  kTwice,      ///< faces on the vertices of an earlier one
  kOpposite,   ///< those that run the other way round
  kOneSided,   ///< edges at which no orientation of their faces fits
  kRepeated,   ///< faces that meet a vertex more than once
  kTouching,   ///< vertices at which fans of faces touch
};

/// All cuts for one reason, by elements of the mesh as given; each list ascending.
struct Cut {
  CutReason reason{};
  std::vector<int> vertices;  ///< for kTouching
  std::vector<Pair> edges;    ///< for kManyFaces and kOneSided: their ends, lower vertex first
  std::vector<int> faces;     ///< for the other reasons
};

/// Lists the cuts that labels and joins of the part's corners make.
/// @param corner_vertices #C the vertices of the surface
std::vector<Cut> cuts(const PolygonPart& part, const CornerLabels& labels, const SideJoins& joins,
                      const std::vector<int>& corner_vertices);

}  // namespace holomorph::mesh
