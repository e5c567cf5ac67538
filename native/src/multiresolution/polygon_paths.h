// Classes and loops of a triangulation whose diagonals were flipped for a progressive mesh, on the input triangulation.
#pragma once

#include "mesh/half_edges.h"
#include "topology/integer_forms.h"

namespace holomorph::multiresolution {

/// Computes the values of closed forms on the diagonals that were flipped: sums along the polygon from one end to the
/// other.
/// @param flipped the surface with other diagonals (progressive::with_single_edges), edges numbered alike
/// @param forms on the edges of `flipped`; changed to those on the edges of `surface`
void values_of_diagonals(const mesh::Surface& surface, const mesh::Surface& flipped, topology::IntegerForms& forms);

/// Converts closed loops of vertices along the edges of `flipped` to loops of half-edges of `surface`. A step along an
/// edge that `surface` does not have becomes a path along the polygon, which is homotopic.
std::vector<std::vector<mesh::HalfedgeHandle>> loops_of_half_edges(const mesh::Surface& surface,
                                                                   const mesh::Surface& flipped,
                                                                   const std::vector<std::vector<int>>& loops,
                                                                   Execution& execution);

}  // namespace holomorph::multiresolution
