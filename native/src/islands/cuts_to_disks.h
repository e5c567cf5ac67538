// Where to cut islands with several boundary loops, or with handles, until they are disks.
#pragma once

#include <vector>

#include "base/execution.h"
#include "mesh/surface.h"

namespace holomorph::islands {

/// Returns for each edge of a polygon whether it is cut, #E. The cuts are short paths from boundary to boundary, and
/// leave disks of the components with a boundary. Disks and closed components are not cut.
///
/// A forest of shortest paths to the boundary is grown first. A spanning tree of the faces crosses none of its edges,
/// and prefers edges far from the boundary. Both leave 1 - chi edges of each component. These and the paths from their
/// ends are the cut (Erickson and Har-Peled 2004, doi:10.1007/s00454-003-2948-z).
/// Cost: O(n log n).
std::vector<char> cuts_to_disks(const mesh::Surface& surface, Execution& execution);

}  // namespace holomorph::islands
