// Which structure a part gets without a choice.
#pragma once

#include "choice/any_structure.h"
#include "structure/solver_report.h"

namespace holomorph::choice {

/// What a disk, a sphere or a part with forms gets without a choice: `conformal_structure` where there are holomorphic
/// forms, the log map of a sphere; of a disk the rectangle with clear corners, the unit disk, or what is most even.
/// @throws TopologyError, SolverError, Cancelled. Source: ours, docs/method/disks.md
StructurePointer automatic_structure(const PartPointer& part, const structure::Options& options, Execution& execution);

}  // namespace holomorph::choice
