// A validated, consistently oriented surface made of polygons, and the triangulation that is computed on.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/page_allocator.h"
#include "base/workers.h"
#include "mesh/polygons.h"

namespace holomorph::mesh {

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

/// Finds the edge between two vertices, -1 if there is none, in O(log #E). @param edges lower end first, in
/// lexicographic order, as those of polygons are
int edge_between(std::span<const Pair> edges, int a, int b);

}  // namespace holomorph::mesh
