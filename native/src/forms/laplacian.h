// The cotan Laplacian of a triangulation.
#pragma once

#include <span>

#include "base/execution.h"
#include "mesh/half_edges.h"
#include "solver/laplacian.h"

namespace holomorph::forms {

/// L = d^T k d for edge weights k; weights of edges with the same ends add up, loops have none.
/// Cost: linear, in parallel.
solver::Laplacian laplacian(const mesh::HalfEdges& half_edges, std::span<const double> weights, Execution& execution);

}  // namespace holomorph::forms
