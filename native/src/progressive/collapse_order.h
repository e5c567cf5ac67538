// The two orders in which edges are collapsed, until none is left that can be. Both report the part of the vertices
// that are gone to `execution`, and throw Cancelled.
#pragma once

#include "base/execution.h"
#include "progressive/edge_collapse.h"

namespace holomorph::progressive {

/// By quadric error, lazily: each vertex is in the queue once, with a cost that was right when it was pushed. When it
/// comes up its star is gathered and its cheapest collapse made, or, if that has become dearer, it is pushed again.
void collapse_by_quadrics(EdgeCollapse& mesh, Execution& execution);

/// By rounds: in each, a maximal set of vertices that are pairwise not adjacent is collapsed, each along its shortest
/// edge that keeps topology and normals.
void collapse_independent_sets(EdgeCollapse& mesh, Execution& execution);

}  // namespace holomorph::progressive
