// How a map between surfaces stretches and turns triangles.
#pragma once

#include <complex>
#include <vector>

#include "base/execution.h"
#include "moduli/carried_uv.h"

namespace holomorph::moduli {

/// In each triangle of `from` the map is z -> p z + q conj(z), linear between the images of the corners. It is
/// conformal where q = 0, and folded where |q| > |p|. Each is laid out in its plane with the first side along the real
/// axis. The image is unfolded into the plane of a triangle of `to` that holds a corner's image.
struct MapDerivatives {
  std::vector<std::complex<double>> p, q;  ///< #T
};

/// @param sign -1 for a map that reverses the orientation: p and q are exchanged
/// Around a vertex whose angle is not 2 pi, unfolding depends on the way round. Of the planes of the three corners'
/// images, the one with the least |q / p| is taken.
/// @pre all images are in one component of `to` @throws Cancelled
/// Cost: linear in both surfaces where triangles' images are small.
MapDerivatives map_derivatives(const mesh::Surface& from, const VertexImages& images, const mesh::Surface& to, int sign,
                               Execution& execution);

}  // namespace holomorph::moduli
