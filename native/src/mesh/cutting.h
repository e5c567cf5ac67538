// Cutting any polygon mesh until it is a surface.
#pragma once

#include <vector>

#include "base/execution.h"
#include "mesh/input_filter.h"
#include "mesh/stitching.h"
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

/// A mesh cut along edges and at vertices: polygons and their corners are those given, in their order.
struct CutSurface {
  Surface surface;
  /// Index of each element in the mesh as given; all empty where that is its own. Vertices ascend. Copies of one vertex
  /// all have its index, and a vertex joined from several has the lowest of theirs.
  std::vector<int> vertex_index, face_index, corner_index;
  int given_vertex_count = 0;
  std::vector<Cut> cuts;               ///< by reasons
  std::vector<Pair> joined_vertices;   ///< given vertices that became one with a lower one, and that one; ascending
  std::vector<RefusedFaces> refused;   ///< faces that are left out, by reasons
  std::vector<Pair> repeated_corners;  ///< given corners that go, see `merge_repeated_corners`, and those for them
  std::vector<int> point_faces;        ///< given faces that go, since their corners lie at one or two places
};

/// Makes a surface as `make_surface` does, but cuts a mesh that `make_surface` refuses: each fan of faces gets its
/// own vertex. Leaves out faces with fewer than three vertices, with coordinates that are not finite or with wild
/// vertices, and parts without area. Corners of a face that follow one another at one vertex are one, and so are the
/// ends of a side that has neither a neighbour nor a length.
///
/// Vertices are joined here, for every door: at sides without a neighbour that run between the same places
/// (first_at_place) in opposite directions. Faces that lie back to back stay two. So a mesh whose vertices are apart
/// along the seams of a UV map, as in glTF files, has no boundary there. Where most sides have no neighbour, faces may
/// also be reversed.
/// @throws InvalidMesh where no face is left
/// Cost: linear for a surface; else O(#C log #C).
CutSurface cut_surface(Polygons polygons, Execution& execution);
CutSurface cut_surface(GivenPolygons polygons, Execution& execution);

}  // namespace holomorph::mesh
