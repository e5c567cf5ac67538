// Conformal invariants from the energies of harmonic forms (paper § 7, § 9).
#pragma once

#include "conformal/holomorphic_basis.h"
#include "structure/energies.h"
#include "structure/topology.h"

namespace holomorph::structure {

struct Invariants {
  CertainGram energies;                     ///< energies of the natural and, with boundary, the Dirichlet forms
  conformal::HolomorphicBasis holomorphic;  ///< star, holomorphic basis and period matrix (Eq. 13) with its bounds
};

/// @throws SolverError
Invariants invariants(const Topology& topology, CertainGram energies);

}  // namespace holomorph::structure
