// Edge collapses by quadric error, until none is left that can be made.
#pragma once

#include "base/execution.h"
#include "progressive/edge_collapse.h"

namespace holomorph::progressive {

/// By quadric error, lazily: each vertex is in the queue once, with a cost that was right when it was pushed. When it
/// comes up its star is gathered and its cheapest collapse made, or, if that has become dearer, it is pushed again.
/// Reports the part of the vertices that are gone. @throws Cancelled
void collapse_by_quadrics(EdgeCollapse& mesh, Execution& execution);

}  // namespace holomorph::progressive
