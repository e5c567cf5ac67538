// From integer classes to harmonic forms and the invariants made of them: the one way that all methods go.
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

/// The functions alone, #V x #forms, those of the loops' harmonic measures 1 on their loops.
/// @throws SolverError, Cancelled
forms::RowMajorMatrix harmonic_functions(const Topology& topology, HarmonicSolver& solver, Execution& execution);

}  // namespace holomorph::structure
