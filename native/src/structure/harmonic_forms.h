// From integer classes to harmonic forms and their invariants. All methods use these two functions.
#pragma once

#include "base/execution.h"
#include "structure/harmonic_solver.h"
#include "structure/measured_forms.h"

namespace holomorph::structure {

/// Solves for the harmonic forms of the topology's classes on the discretisation of `solver`, keeps or streams them as
/// its plan says, and measures them.
/// @pre the surface has handles or at least two boundary loops. @throws SolverError, Cancelled
HarmonicForms harmonic_forms(const mesh::Surface& surface, const Topology& topology, HarmonicSolver& solver,
                             Execution& execution);

/// Solves for the functions alone, #V x #forms. Those of the loops' harmonic measures are 1 on their loops.
/// @throws SolverError, Cancelled
forms::RowMajorMatrix harmonic_functions(const Topology& topology, HarmonicSolver& solver, Execution& execution);

}  // namespace holomorph::structure
