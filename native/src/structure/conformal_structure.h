// The whole method in its order (paper § 4 to § 9): read conformal_structure.cpp first.
#pragma once

#include <optional>

#include "base/execution.h"
#include "structure/solver_report.h"
#include "structure/structure.h"

namespace holomorph::structure {

/// Begins a structure: its surface, and a plan that fits into memory, before anything large is made.
/// @throws TopologyError for a sphere or a disk, naming genus and boundary count; SolverError
Structure planned_structure(std::shared_ptr<const mesh::Surface> surface, const Options& options, Keeping keeping);

/// Computes the structure of a closed surface of genus g >= 1, or of genus g with b >= 1 boundary loops, n = 2g + b - 1
/// >= 1. With boundary the symmetric forms of the double are the natural forms, the antisymmetric ones the Dirichlet
/// forms. The star exchanges them, so the double itself is not needed.
/// @param given loops zeta and their dual classes, lifted and pulled back from the base of a progressive mesh; by
/// default they are found on the surface
/// @pre connected, no isolated vertices (mesh::component makes it so)
/// @throws TopologyError for a sphere or a disk, naming genus and boundary count; SolverError; Cancelled
Structure conformal_structure(std::shared_ptr<const mesh::Surface> surface, const Options& options,
                              Execution& execution, std::optional<topology::DualBases> given = {});

}  // namespace holomorph::structure
