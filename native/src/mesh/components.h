// Cutting a surface into its connected components.
#pragma once

#include <vector>

#include "mesh/surface.h"

namespace holomorph::mesh {

/// A connected component as a surface of its own, without isolated vertices. The indices grow with the parent's, so
/// lower and higher vertex of an edge stay what they were.
struct Component {
  Surface surface;
  std::vector<int> vertex_index, face_index, corner_index;  ///< of each element in the parent
};

Component component(const Surface& surface, int which, Execution& execution);

/// Euler characteristic of a connected surface, its isolated vertices not counted.
int euler_characteristic(const Surface& surface);

/// Number of boundary loops of a surface, without building its half-edges.
int boundary_count(const Surface& surface);

/// (2 - chi - boundary loops) / 2
int genus(int euler_characteristic, int boundary_count);

}  // namespace holomorph::mesh
