// What is known of harmonic forms that are never there all at once.
#pragma once

#include <span>

#include "base/execution.h"
#include "structure/harmonic_systems.h"
#include "structure/structure.h"

namespace holomorph::structure {

/// Solves for the harmonic forms of a closed surface result.memory.block at a time, measures each block and lets it go:
/// the Gram matrix from <eta_i, h_j>, the certificate, and the samples that the balance needs are left.
/// @param triangulation,weights,classes what is solved on, and the classes there
/// Memory: that of the plan. @throws SolverError, Cancelled
void measure_in_blocks(const mesh::HalfEdges& triangulation, std::span<const double> weights,
                       std::span<const double> errors, HarmonicSystems& systems, topology::IntegerForms&& classes,
                       Structure& result, Execution& execution);

}  // namespace holomorph::structure
