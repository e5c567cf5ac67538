#include "structure/invariants.h"

#include <utility>

namespace holomorph::structure {

Invariants invariants(const Topology& topology, CertainGram energies) {
  const auto& [gram, certain] = energies;
  auto holomorphic = topology.families.dirichlet > 0
                         ? conformal::bounded_basis(gram, certain, topology.pairing, topology.type.genus)
                         : conformal::closed_basis(gram[0], certain[0], topology.pairing, topology.canonical);
  return {std::move(energies), std::move(holomorphic)};
}

}  // namespace holomorph::structure
