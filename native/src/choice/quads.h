// A mesh of quads over a part: the cells of a tiling that turns by quarters.
#pragma once

#include <vector>

#include "choice/tilers.h"
#include "tiles/cells.h"
#include "uv/evening.h"

namespace holomorph::choice {

struct QuadOptions {
  double faces = 2000;  ///< the number that is wanted
  /// What rows end at (kWhole) or run along (kFree), as far as that leaves the mesh whole; kMirror: two halves that are
  /// alike
  tiling::Rows lines = tiling::Rows::kWhole;
  std::vector<mesh::Pair> marked = {};  ///< vertices of edges that are lines besides hard edges and boundaries
  double evenness = uv::kUsualEvenness;
};

struct Quads {
  tiles::Cells cells;   ///< quads, but where rows are cut off or folded; one is a square of the corners' points
  SeamlessPointer map;  ///< of which each tile has four
};

/// The quads of the part of these tilings, which are kept: their vertices lie on it, and they have its topology.
/// Irregular vertices are the cones.
/// @throws TopologyError where there is no such tiling, or it would lose a part of the surface: names how many faces
/// are enough; SolverError; Cancelled. Source: cones as corners of a grid are of Bommes et al. 2009 and Ray et al.
/// 2006; how they are found is ours, docs/method/turns.md
Quads quads(Tilers& tilers, const QuadOptions& options, Execution& execution);

}  // namespace holomorph::choice
