// A polygon mesh as plain arrays, about which nothing has been checked.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace holomorph::mesh {

/// What messages say of a mesh's elements and of the file that it is from.
struct FileRecord {
  int first_number = 0;                       ///< of vertices and faces, as the format counts them
  std::vector<int> face_index, corner_index;  ///< places in the file; empty where nothing was left out
  std::vector<std::string> notes;             ///< sentences about what is wrong, although the rest was read

  std::string vertex(std::int64_t v) const { return std::to_string(first_number + v); }
  std::string face(std::int64_t f) const {
    return std::to_string(first_number + (face_index.empty() ? f : face_index[static_cast<std::size_t>(f)]));
  }
};

template <class Index>
struct BasicPolygons {
  std::vector<std::array<double, 3>> vertices;  ///< #V positions; empty for an intrinsic surface
  std::vector<Index> corner_vertices;           ///< #C vertex of each polygon corner, polygon by polygon
  std::vector<Index> face_offsets;  ///< #F + 1; polygon f has corners face_offsets[f] .. face_offsets[f+1]-1
  FileRecord file = {};             ///< of a mesh that was read
};

/// Indices as in all computations.
using Polygons = BasicPolygons<int>;
/// Indices as files and applications give them, unchecked.
using GivenPolygons = BasicPolygons<std::int64_t>;

}  // namespace holomorph::mesh
