// Islands of a surface, each flattened by itself.
#pragma once

#include <vector>

#include "base/execution.h"
#include "mesh/surface.h"
#include "uv/uv_map.h"

namespace holomorph::flat {

struct Flattening {
  uv::UvArray uv;                     ///< #C x 2, each island about 0; 0 where it is not flat
  std::vector<double> scale_factors;  ///< #V length in the plane over that on the surface, 1 on the boundary
  std::vector<char> is_flat;          ///< #components, whether each was mapped
};

/// Maps each component that is a disk by flat::free_boundary_map. A component that is not a disk, or
/// for which a solver fails, is not flat.
/// @param surface cut open along its seams: its islands are its components
/// @throws Cancelled
/// Cost: one factorisation for each island.
Flattening flattened(const mesh::Surface& surface, Execution& execution);

/// Returns the UVs of flat islands, #C x 2. Islands that stretch are evened, and each has the area that it has on the
/// surface.
/// @param evenness from 0 to 1. @throws Cancelled
uv::UvArray evened(const mesh::Surface& surface, const Flattening& flattening, double evenness, Execution& execution);

}  // namespace holomorph::flat
