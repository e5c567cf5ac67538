// The surroundings of flipped triangles, to be evened by themselves.
#pragma once

#include <vector>

#include "evening/strain_energy.h"

namespace holomorph::evening {

/// A part of the surface; its map is the one with delta.
struct StrainEnergy::Patch {
  StrainEnergy energy;
  std::vector<int> vertices;  ///< of the surface, by its own: first those that are free to move,
  int free_count = 0;         ///< so many, then the others
};

}  // namespace holomorph::evening
