// Small holes filled, so that a piece with holes is flattened as a disk.
#pragma once

#include "base/execution.h"
#include "mesh/surface.h"

namespace holomorph::islands {

/// Fills small holes with a polygon each, appended at the end. A hole is small if its component has genus 0 and another
/// loop of it is more than twice as long. Corners and polygons keep their numbers; diagonals may change.
/// @throws Cancelled
mesh::Surface filled(const mesh::Surface& surface, Execution& execution);

}  // namespace holomorph::islands
