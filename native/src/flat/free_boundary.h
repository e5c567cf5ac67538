// The conformal map of a disk to the plane with a free boundary and the least variation of density.
#pragma once

#include "base/execution.h"
#include "flat/dirichlet_problem.h"
#include "mesh/surface.h"

namespace holomorph::flat {

/// Computes the conformal map to the plane that keeps lengths along the boundary. Its scale factors are e^u, with u = 0
/// on the boundary. Among all conformal maps this u has the least Dirichlet energy. A surface that is flat already is
/// mapped by a rigid motion.
///
/// In the interior L u = -K, with K the angle defect from 2 pi. The flattened boundary turns by k + L u at each vertex,
/// with k the defect from pi. The curve with these angles is closed by the lengths nearest to those of the surface.
/// Both coordinates are extended harmonically. Where curvature is large and the mesh coarse the image may overlap
/// itself.
///
/// The lowest boundary vertex lies at 0, and the edge that leaves it, the surface on its left, along the real axis.
/// @throws TopologyError for a surface that is not a disk; SolverError; Cancelled
/// Cost: one factorisation, three right-hand sides.
/// Source: Sawhney & Crane 2017, section 4, doi:10.1145/3132705.
PlaneMap free_boundary_map(const mesh::Surface& surface, const Options& options, Execution& execution);

}  // namespace holomorph::flat
