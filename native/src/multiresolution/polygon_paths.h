// Where diagonals of polygons were turned for a progressive mesh: classes and loops on the artist's own diagonals.
#pragma once

#include "mesh/half_edges.h"
#include "topology/integer_forms.h"

namespace holomorph::multiresolution {

/// The values of closed forms on the diagonals that were turned: the sum along the polygon from one end to the other,
/// which no diagonal changes.
/// @param turned the surface with other diagonals (progressive::with_single_edges), edges numbered alike
/// @param forms on the edges of `turned`; changed to those on the edges of `surface`
void values_of_diagonals(const mesh::Surface& surface, const mesh::Surface& turned, topology::IntegerForms& forms);

/// Closed loops of vertices that run along the edges of `turned`, as loops on the half-edges of `surface`: a step along
/// an edge that `surface` has not becomes a path along the polygon, which is homotopic.
std::vector<std::vector<mesh::HalfedgeHandle>> loops_of_half_edges(const mesh::Surface& surface,
                                                                   const mesh::Surface& turned,
                                                                   const std::vector<std::vector<int>>& loops);

}  // namespace holomorph::multiresolution
