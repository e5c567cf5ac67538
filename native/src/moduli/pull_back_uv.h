// UVs and derivatives carried along a map of surfaces: pull-back.
#pragma once

#include <array>
#include <complex>
#include <vector>

#include "base/execution.h"
#include "mesh/surface.h"

namespace holomorph::moduli {

/// Where a map takes the vertices of a surface of polygons: into triangles of another.
struct VertexImages {
  std::vector<int> triangles;                      ///< #V, -1 at isolated vertices
  std::vector<std::array<double, 3>> barycentric;  ///< #V
};

/// Pulls UVs at the corners of `to`, one for each polygon corner, back to the corners of `from`.
///
/// The UVs are continued from triangle to triangle over `to`. Across a cut, they are continued by the similarity that
/// brings the UVs on both sides of the edge together (a translation, for maps made of forms). All corners of a polygon
/// take the chart at its middle. So a texture that is continuous across a cut of `to` is continuous on `from`. Where it
/// breaks off, it breaks off along the nearest edges.
/// @pre every polygon's images are in one component of `to` @throws Cancelled
/// Cost: linear in both surfaces where polygons' images are small.
std::vector<std::complex<double>> carried_uv(const mesh::Surface& from, const VertexImages& images,
                                             const mesh::Surface& to, const std::vector<std::complex<double>>& uv,
                                             Execution& execution);

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
