// The cotan Laplacian of a triangulation, assembled from the weights of its edges.
#pragma once

#include <span>

#include "base/execution.h"
#include "mesh/half_edges.h"
#include "solver/laplace_solver.h"

namespace holomorph::forms {

/// Assembles L = d^T k d, #V x #V, for edge weights k. Edges with the same ends add up. A loop adds nothing, as
/// functions have no difference along it.
/// @param weights #E, cotangent weights without unit
/// @throws Cancelled
/// Cost: linear, in parallel.
solver::Laplacian laplacian(const mesh::HalfEdges& half_edges, std::span<const double> weights, Execution& execution);

}  // namespace holomorph::forms
