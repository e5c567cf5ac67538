// From polygons to a surface: checked, oriented and triangulated.
#pragma once

#include "base/execution.h"
#include "mesh/surface.h"

namespace holomorph::mesh {

/// Checks, orients and triangulates a polygon mesh. Each polygon is cut along the diagonals that minimise the sum of
/// (a^2 + b^2 + c^2) / area over its triangles. For planar convex polygons this is the Delaunay triangulation (Musin
/// 1997). At the boundary diagonals end at interior vertices where they can.
/// @throws InvalidMesh, TopologyError (non-orientable), naming the first bad element.
/// Cost: linear in the number of corners, cubic in the size of a polygon up to 64 corners.
Surface make_surface(Polygons polygons, Execution& execution);
Surface make_surface(GivenPolygons polygons, Execution& execution);

/// The steps of make_surface, after `check_polygons`. `narrowed` converts indices to int. `complete` computes all else
/// from `surface.polygons`, which it does not change even if it throws.
Polygons narrowed(GivenPolygons polygons);
inline Polygons narrowed(Polygons polygons) { return polygons; }
void complete(Surface& surface, const MeshLabels& label, Execution& execution);

}  // namespace holomorph::mesh
