// A polygon mesh as plain arrays, as a file or an application gives it: nothing about it has been checked.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace holomorph::mesh {

struct Polygons {
  std::vector<std::array<double, 3>> vertices;  ///< #V positions; empty for an intrinsic surface
  std::vector<std::int64_t> corner_vertices;    ///< #C vertex of each polygon corner, polygon by polygon
  std::vector<std::int64_t> face_offsets;  ///< #F + 1; polygon f has corners face_offsets[f] .. face_offsets[f+1]-1
};

}  // namespace holomorph::mesh
