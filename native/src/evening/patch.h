// Turning back what evening flips: descents on small patches around it.
#pragma once

#include <vector>

#include "base/execution.h"
#include "evening/strain_energy.h"
#include "evening/unknowns.h"

namespace holomorph::evening {

/// The energy of a connected part of the surface. Its map is the one with delta, so that its own function starts at 0.
struct StrainEnergy::Patch {
  StrainEnergy energy;
  std::vector<int> vertices;  ///< vertices of the surface: the free ones first
  int free_count = 0;         ///< how many of them are free to move
  double flipped_before = 0;  ///< the area that the map without delta flips
};

/// Turns triangles back that delta flips, patch by patch, until none has more flipped area than the map without delta;
/// or none at all where functions turn: there whole numbers flip triangles, at cones. Only the patches move.
/// @param delta on the whole surface; changed where that flips less
/// @param vertex_steps steps left, each times the vertices of its patch
/// @return the area that delta then flips beyond that
/// @throws SolverError, Cancelled
double turn_back(const StrainEnergy& energy, const Kept& kept, double lambda, StrainEnergy::Rings rings,
                 Function& delta, double& vertex_steps, Execution& execution);

}  // namespace holomorph::evening
