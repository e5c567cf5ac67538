// From integer classes to harmonic forms and the invariants made of them: the one way that all methods go.
#pragma once

#include <memory>

#include "base/execution.h"
#include "structure/certificate.h"
#include "structure/harmonic_solver.h"
#include "structure/invariants.h"
#include "structure/topology.h"
#include "uv/balance.h"

namespace holomorph::structure {

/// The harmonic forms eta_j + d f_j of a surface, measured.
struct HarmonicForms {
  std::shared_ptr<const forms::RowMajorMatrix> functions;  ///< #V x #forms; null if streamed
  uv::FormSamples samples;                                 ///< of streamed forms, for the balance
  Invariants invariants;
  Certificate certificate;
};

/// Solves for the harmonic forms of the topology's classes on the discretisation of `solver`, keeps or streams them as
/// its plan says, and measures them.
/// @pre the surface has handles or at least two boundary loops. @throws SolverError, Cancelled
HarmonicForms harmonic_forms(const mesh::Surface& surface, const Topology& topology, HarmonicSolver& solver,
                             Execution& execution);

/// The functions alone, #V x #forms, those of the loops' harmonic measures 1 on their loops.
/// @throws SolverError, Cancelled
forms::RowMajorMatrix harmonic_functions(const Topology& topology, HarmonicSolver& solver, Execution& execution);

/// Measures functions that were solved for: energies and what follows from them, and the certificate.
/// @param classes those of the topology on the discretisation, see classes_on
/// @param functions #V x #forms. @throws SolverError
HarmonicForms measured(const mesh::Surface& surface, const Topology& topology,
                       const mesh::Discretisation& discretisation, const topology::IntegerForms& classes,
                       forms::RowMajorMatrix functions, Execution& execution);

}  // namespace holomorph::structure
