// The forms of a surface with boundary by way of its double: the paper's own path (§ 8), the reference for the other.
#pragma once

#include <span>

#include "base/execution.h"
#include "structure/harmonic_systems.h"
#include "structure/options.h"

namespace holomorph::structure {

/// As HarmonicSystems::solve, but every form is solved for on the closed double: the symmetric extension of each
/// natural class and the antisymmetric one of each Dirichlet class. The solutions are symmetrised (Eq. 12), f(v) +
/// f(v*) and f(v) - f(v*), v* the dual vertex, and restricted to the surface. They are those of the surface itself to
/// solver accuracy, at twice the size. The double has the edge weights of the surface: edges of the boundary count
/// twice.
/// @throws SolverError, Cancelled
HarmonicFunctions solve_on_double(const mesh::HalfEdges& half_edges, std::span<const double> weights,
                                  const topology::IntegerForms& classes, int natural, const Options& options,
                                  Execution& execution);

}  // namespace holomorph::structure
