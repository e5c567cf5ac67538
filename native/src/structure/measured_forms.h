// Harmonic forms with what is measured of them: energies, invariants, certificate.
#pragma once

#include <memory>

#include "base/execution.h"
#include "structure/certificate.h"
#include "structure/invariants.h"
#include "structure/topology.h"
#include "uv/balance.h"

namespace holomorph::structure {

/// The harmonic forms eta_j + d f_j of a surface, measured.
struct HarmonicForms {
  std::shared_ptr<const forms::RowMajorMatrix> functions;  ///< #V x #forms; null if streamed
  uv::FormSamples samples;                                 ///< samples of streamed forms, for the balance
  Invariants invariants;
  Certificate certificate;
};

/// Measures functions that were solved for: energies and what follows from them, and the certificate.
/// @param classes those of the topology on the discretisation, see classes_on
/// @param functions #V x #forms. @throws SolverError
HarmonicForms measured(const mesh::Surface& surface, const Topology& topology,
                       const mesh::Discretisation& discretisation, const topology::IntegerForms& classes,
                       forms::RowMajorMatrix functions, Execution& execution);

}  // namespace holomorph::structure
