// Edges that are lines of the lattice: rows of tiles run along them.
#pragma once

#include <vector>

#include "tiling/cones/cones.h"
#include "tiling/cones/transitions.h"

namespace holomorph::tiling {

struct Lines {
  std::vector<int> edges;  ///< of the surface, also of its boundary
  bool are_whole = false;  ///< rows end at them; otherwise they lie anywhere across
};

/// The long chains of some edges, and the boundary loops that turn little to and fro. @return ascending edges
std::vector<int> long_lines(const mesh::Surface& surface, const std::vector<int>& hard);

/// Cones and frames of the smoothest level field that runs along the lines of the net. Its cones stay within the
/// patches between lines, or on these; frames are as near to parallel as the lines let them be.
/// @param missing out: #V, cones. @throws SolverError, Cancelled
Frames lined_frames(const mesh::Surface& surface, const Net& net, const ConeOptions& options, std::vector<int>& missing,
                    Execution& execution);

}  // namespace holomorph::tiling
