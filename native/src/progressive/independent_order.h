// Edge collapses by rounds of independent vertices, until none is left that can be made.
#pragma once

#include "base/execution.h"
#include "progressive/edge_collapse.h"

namespace holomorph::progressive {

/// Works in rounds. Each collapses a maximal set of pairwise non-adjacent vertices, each along its shortest edge that
/// keeps topology and normals. Reports the fraction of vertices removed. @throws Cancelled
void collapse_independent_sets(EdgeCollapse& mesh, Execution& execution);

}  // namespace holomorph::progressive
