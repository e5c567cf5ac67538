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

/// UVs at the corners of `to`, one for each polygon corner, carried to the corners of `from`.
///
/// The corners of one polygon get theirs in one chart. The UVs are continued from triangle to triangle over `to`.
/// Across each cut this is done by the similarity that brings the edge's UVs on both sides together (a translation, for
/// maps made of forms). Of the charts that a polygon touches, its middle's is taken. A texture that goes on across a
/// cut so does here; where it breaks off there, it breaks off along the nearest edges.
/// @pre every polygon's images are in one component of `to` @throws Cancelled
/// Cost: linear in both surfaces where polygons' images are small.
std::vector<std::complex<double>> carried_uv(const mesh::Surface& from, const VertexImages& images,
                                             const mesh::Surface& to, const std::vector<std::complex<double>>& uv,
                                             Execution& execution);

}  // namespace holomorph::moduli
