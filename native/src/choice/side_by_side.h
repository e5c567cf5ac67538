// Work on the parts of a mesh in several threads.
#pragma once

#include <functional>
#include <vector>

#include "base/execution.h"

namespace holomorph::choice {

/// Calls work(k, execution) for each part. Parts of at least 20,000 triangles have all threads in turn. Then the others
/// are done side by side, the largest first, each with one thread. Results may depend neither on the order nor on the
/// number of threads. Of several errors the first one by k is thrown; the calling thread alone reports, and cancels.
/// @param sizes triangles of the parts
void side_by_side(const std::vector<int>& sizes, Execution& execution,
                  const std::function<void(int, Execution&)>& work);

}  // namespace holomorph::choice
