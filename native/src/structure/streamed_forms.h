// Harmonic forms that are never in memory all at once.
#pragma once

#include "structure/harmonic_solver.h"
#include "structure/measured_forms.h"

namespace holomorph::structure {

/// Solves for the harmonic forms of a closed surface, as many at a time as the plan says, measures each block and drops
/// it. The result has the Gram matrix, computed from <eta_i, h_j>, the certificate and the samples for the balanced
/// map.
/// @param classes on the discretisation of the solver
/// Memory: that of the plan. @throws SolverError, Cancelled
HarmonicForms streamed_forms(const mesh::Surface& surface, const Topology& topology, HarmonicSolver& solver,
                             const topology::IntegerForms& classes, Execution& execution);

}  // namespace holomorph::structure
