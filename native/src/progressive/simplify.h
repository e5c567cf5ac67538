// From a surface to its progressive mesh.
#pragma once

#include <optional>
#include <vector>

#include "base/execution.h"
#include "mesh/surface.h"
#include "progressive/refinement.h"

namespace holomorph::progressive {

/// Flips diagonals that have the same ends as another edge, inside the quadrilateral of their two triangles. With such
/// diagonals the polygons are a valid mesh, but their triangles are not.
/// @return the surface with other triangles, their corners and edges (its lengths are not updated); nothing if no two
/// edges have the same ends
/// @throws InvalidMesh for an intrinsic surface, and where a flip gives another double edge
std::optional<mesh::Surface> with_single_edges(const mesh::Surface& surface);

/// Which edges are collapsed first.
enum class Order {
  quadric,      ///< by quadric error (Garland & Heckbert 1997, doi:10.1145/258734.258849)
  independent,  ///< by rounds; the vertices removed in one round are pairwise not adjacent
};

/// Collapses edges until none can be collapsed. Genus 0 ends with 4 triangles, genus 1 with at most 20: larger
/// irreducible triangulations do not exist (Lawrencenko 1987). Collapses obey the link condition (Dey et al. 1999), so
/// that every level has the topology of the original and no two edges with the same ends; boundary vertices move along
/// the boundary only. As long as possible no normal rotates by more than 75 degrees. Where that would leave a base
/// without any area, the last collapses are left out. A diagonal with the same ends as another edge is flipped first
/// (with_single_edges).
/// @param kept vertices of every level
/// @throws InvalidMesh for an intrinsic surface, or if a flip gives another double edge; Cancelled. Deterministic, one
/// thread, O(#T) apart from very large stars.
ProgressiveMesh progressive_mesh(const mesh::Surface& surface, Order order, Execution& execution,
                                 const std::vector<int>& kept = {});

}  // namespace holomorph::progressive
