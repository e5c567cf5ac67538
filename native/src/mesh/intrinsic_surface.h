// Surfaces of triangles and edge lengths, without positions.
#pragma once

#include "base/execution.h"
#include "mesh/surface.h"

namespace holomorph::mesh {

/// Makes an intrinsic surface: triangles and the lengths of their edges, without positions.
/// @param faces #F vertices; a vertex may come twice in a triangle
/// @param lengths #F lengths, entry i opposite corner i; both triangles at an edge must agree to 1e-9
/// @param face_edges #F edge names, entry i opposite corner i; empty: edges are told apart by their ends
Surface make_intrinsic_surface(int vertex_count, const std::vector<std::array<std::int64_t, 3>>& faces,
                               const std::vector<std::array<double, 3>>& lengths,
                               const std::vector<std::array<std::int64_t, 3>>& face_edges, Execution& execution);

}  // namespace holomorph::mesh
