// A polygon mesh as plain arrays, about which nothing has been checked.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace holomorph::mesh {

template <class Index>
struct BasicPolygons {
  std::vector<std::array<double, 3>> vertices;  ///< #V positions; empty for an intrinsic surface
  std::vector<Index> corner_vertices;           ///< #C vertex of each polygon corner, polygon by polygon
  std::vector<Index> face_offsets;  ///< #F + 1; polygon f has corners face_offsets[f] .. face_offsets[f+1]-1
};

/// Indices as in all computations.
using Polygons = BasicPolygons<int>;
/// Indices as files and applications give them, unchecked.
using GivenPolygons = BasicPolygons<std::int64_t>;

}  // namespace holomorph::mesh
