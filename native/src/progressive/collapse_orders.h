// The orders in which edges collapse.
#pragma once

#include "base/execution.h"
#include "progressive/edge_collapse.h"

namespace holomorph::progressive {

/// Works in rounds. Each collapses a maximal set of pairwise non-adjacent vertices, each along its shortest edge that
/// keeps topology and normals. Reports the fraction of vertices removed. @throws Cancelled
void collapse_independent_sets(EdgeCollapse& mesh, Execution& execution);

/// Collapses by quadric error, lazily. Each vertex is in the queue at most once, with its cost when it was pushed. When
/// it is popped, its star is gathered and its cheapest collapse made; if the cost has grown, it is pushed again
/// instead. Reports the fraction of vertices removed. @throws Cancelled
void collapse_by_quadrics(EdgeCollapse& mesh, Execution& execution);

}  // namespace holomorph::progressive
