// The paper's multiresolution algorithm as a whole (§ 9): the conformal structure of a surface by the levels of a
// progressive mesh. With boundary it uses the doubles of the levels (§ 8).
#pragma once

#include <optional>

#include "base/execution.h"
#include "multiresolution/paper_forms.h"
#include "structure/options.h"
#include "structure/structure.h"

namespace holomorph::multiresolution {

/// Computes a conformal structure. Loops are lifted from the base mesh, classes are pulled back, and harmonic forms
/// come from paper_forms. No edge is flipped: all results belong to the surface's own triangulation.
/// @param levels of a given progressive mesh; by default it is made here
/// @pre connected, no isolated vertices
/// @throws TopologyError for a sphere or a disk; InvalidMesh for an intrinsic surface; SolverError; Cancelled
structure::Structure paper_structure(std::shared_ptr<const mesh::Surface> surface, const structure::Options& options,
                                     Execution& execution, PaperOptions how = {},
                                     std::optional<PaperLevels> levels = {});

}  // namespace holomorph::multiresolution
