// Intrinsic Delaunay triangulations.
#pragma once

#include "base/execution.h"
#include "mesh/intrinsic_triangulation.h"

namespace holomorph::mesh {

/// Flips edges until every interior edge is Delaunay, cot + cot >= 0 up to rounding (Fisher et al. 2007,
/// doi:10.1007/s00607-007-0249-8). In exact arithmetic it ends because every flip lowers the Dirichlet energy of every
/// function (Rippa 1990), so no triangulation recurs. In rounded arithmetic it ends because the flips of each edge are
/// limited.
/// Cost: linear in the number of flips, which is about a fifth of the edges of irregular meshes. Flips are made in
/// parallel where faces with near numbers are near each other, with the same result at any number of threads. A
/// degenerate triangle goes with the flip of its longest side, and the metric is still that of the surface. Only those
/// with a side without length, or with their longest side on the boundary, are mollified.
void make_delaunay(IntrinsicTriangulation& triangulation, Execution& execution);

}  // namespace holomorph::mesh
