// A polygon mesh as plain arrays, about which nothing has been checked: its labels in messages, and parts of it.
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
  bool has_more = false;                      ///< of OBJ: UVs, materials, colours or several objects

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

/// The number of an element in the mesh that the caller knows, of which this one may be a part.
class Labels {
 public:
  /// @param labels one for each element, which outlive this; empty: its own index
  explicit Labels(const std::vector<int>& labels) : labels_(labels) {}
  std::string operator()(int element) const { return std::to_string(labels_.empty() ? element : labels_[element]); }

 private:
  const std::vector<int>& labels_;
};

/// The labels of the vertices and of the faces of a mesh; by default their own indices.
struct MeshLabels {
  static inline const std::vector<int> kOwnIndices;
  Labels vertex{kOwnIndices}, face{kOwnIndices};
  bool is_part = false;  ///< of a mesh, in whose numbers they are
};

/// The vertices keep their order, so the lower end of an edge remains the lower one.
struct PolygonPart {
  Polygons polygons;                                        ///< without positions where the whole has none
  std::vector<int> vertex_index, face_index, corner_index;  ///< each element's index in the whole
};

/// Takes parts out, one after the other, each in time linear in its own size.
class PolygonParts {
 public:
  /// The mesh outlives this.
  explicit PolygonParts(const Polygons& whole);

  /// @param faces ascending; their vertices exist
  PolygonPart take(std::vector<int> faces);

 private:
  const Polygons& whole_;
  std::vector<int> new_vertex_;  // in the part that is taken, else -1
};

}  // namespace holomorph::mesh
