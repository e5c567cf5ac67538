// A neighbourhood of flipped triangles, evened by itself.
#pragma once

#include <vector>

#include "evening/strain_energy.h"

namespace holomorph::evening {

/// The energy of a part of the surface. Its map is the one with delta, so that its own function starts at 0.
struct StrainEnergy::Patch {
  StrainEnergy energy;
  std::vector<int> vertices;  ///< vertices of the surface: the free ones first
  int free_count = 0;         ///< how many of them are free to move
};

}  // namespace holomorph::evening
