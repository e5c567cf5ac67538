// The conformal map of a disk to the plane with a free boundary and the least variation of density.
#pragma once

#include "base/execution.h"
#include "mesh/surface.h"
#include "plane/plane_map.h"

namespace holomorph::plane {

/// The conformal map to the plane that keeps lengths along the boundary. Its scale factors e^u, u = 0 on the boundary,
/// have the least Dirichlet energy of u, up to a constant. A surface that is flat already is mapped by a rigid motion.
///
/// The curvature asks L u = -K inside. The flattened boundary turns by k + L u at each vertex. The curve with these
/// angles is closed, with the lengths nearest to those of the surface. Both coordinates are extended harmonically.
/// Where curvature is large and the mesh coarse the image may overlap itself.
///
/// The lowest boundary vertex lies at 0, and the edge that leaves it, the surface on its left, along the real axis.
/// @throws TopologyError for a surface that is no disk; SolverError; Cancelled
/// Cost: one factorisation, three right-hand sides.
/// Source: \cite SawhneyCrane2017, section 4.
PlaneMap free_boundary_map(const mesh::Surface& surface, const Options& options, Execution& execution);

}  // namespace holomorph::plane
