// UVs of one surface's corners on another, along a map between them.
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

}  // namespace holomorph::moduli
