// Edge collapses by quadric error, until none is left that can be made.
#pragma once

#include "base/execution.h"
#include "progressive/edge_collapse.h"

namespace holomorph::progressive {

/// Collapses by quadric error, lazily. Each vertex is in the queue at most once, with its cost when it was pushed. When
/// it is popped, its star is gathered and its cheapest collapse made; if the cost has grown, it is pushed again
/// instead. Reports the fraction of vertices removed. @throws Cancelled
void collapse_by_quadrics(EdgeCollapse& mesh, Execution& execution);

}  // namespace holomorph::progressive
