// A validated, consistently oriented surface made of polygons, and the triangulation that is computed on.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/page_allocator.h"
#include "base/workers.h"

namespace holomorph::mesh {

// A polygon mesh as plain arrays, about which nothing has been checked: its labels in messages, and parts of it.

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

using Triple = std::array<int, 3>;
using Pair = std::array<int, 2>;

/// What was wrong with the input and handled inside; the input itself is never changed.
struct Repairs {
  std::vector<int> reversed_faces;     ///< polygons read in reverse, so that each component is oriented consistently
  std::vector<int> isolated_vertices;  ///< vertices of no polygon
  std::vector<int> zero_area_faces;    ///< polygons with a triangle whose corners lie on a line
};

/// Edges are known by their index, never by their pair of ends: two edges may share both ends.
/// Side i of triangle t runs from its corner i to its corner i+1.
struct Surface {
  Polygons polygons;               ///< as given
  int vertex_count = 0;            ///< isolated vertices included
  Array<Triple> triangles;         ///< #T vertices, counter-clockwise after repairs
  Array<Triple> triangle_corners;  ///< #T indices into polygons.corner_vertices
  Array<Triple> triangle_edges;    ///< #T edge of each side
  Array<int> triangle_faces;       ///< #T polygon of each triangle
  Array<Pair> edges;               ///< #E ends, lower vertex first: the polygons' edges, then the diagonals
  int polygon_edge_count = 0;      ///< edges before this index are the polygons', the others diagonals
  Array<double> edge_lengths;      ///< #E, in the unit of the positions
  Array<int> face_component;       ///< #F connected component of each polygon, numbered by first polygon
  int component_count = 0;
  Array<char> edge_face_count;  ///< #E number of triangles at each edge, 1 or 2
  /// #T, how much larger energies may be on the original surface, relatively, if this one is a refinement of it with
  /// rounded lengths; empty: this is the original.
  Array<double> metric_errors;
  Repairs repairs;

  bool intrinsic() const { return polygons.vertices.empty(); }
  bool is_diagonal(int edge) const { return edge >= polygon_edge_count; }
  bool has_diagonals() const { return polygon_edge_count < static_cast<int>(edges.size()); }
};

/// Sum of the areas of the triangles.
double area(const Surface& surface, Workers& workers);

/// Returns a third of the areas of the triangles at each vertex, #V. @param lengths #E
std::vector<double> vertex_areas(const Surface& surface, std::span<const double> lengths);

/// The sides of triangles at each edge, #E, ascending: side i of triangle t is 3 t + i. The second is -1 on the
/// boundary.
std::vector<Pair> edge_sides(const Surface& surface);

/// The polygons of these, #E: the same one twice at a diagonal.
std::vector<Pair> edge_faces(const Surface& surface);

/// Finds the edge between two vertices, -1 if there is none, in O(log #E). @param edges lower end first, in
/// lexicographic order, as those of polygons are
int edge_between(std::span<const Pair> edges, int a, int b);

}  // namespace holomorph::mesh
