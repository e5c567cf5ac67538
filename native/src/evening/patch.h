// The surroundings of flipped triangles, to be evened by themselves.
#pragma once

#include <vector>

#include "evening/strain_energy.h"

namespace holomorph::evening {

/// A part of the surface; its map is the one with delta.
struct StrainEnergy::Patch {
  StrainEnergy energy;
  std::vector<int> vertices;  ///< vertices of the surface: the free ones first
  int free_count = 0;         ///< how many of them are free to move
};

}  // namespace holomorph::evening
