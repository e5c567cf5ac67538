// Small holes filled, so that a piece with holes is flattened as a disk.
#pragma once

#include "base/execution.h"
#include "mesh/surface.h"

namespace holomorph::islands {

/// The surface with one more polygon, at the end, in each small hole: of a component of genus 0 each boundary loop that
/// is shorter than half its longest. Corners and polygons keep their numbers; diagonals may change.
/// @throws Cancelled
mesh::Surface filled(const mesh::Surface& surface, Execution& execution);

}  // namespace holomorph::islands
