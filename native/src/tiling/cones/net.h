// A triangulation laid out triangle by triangle, for directions that are carried from one to the next.
#pragma once

#include <complex>
#include <vector>

#include "base/constants.h"
#include "mesh/surface.h"

namespace holomorph::tiling {

/// Side 3 t + i runs from corner i of triangle t to corner i + 1. The plane of a triangle has its corner 0 at 0, and
/// its side 0 along the real axis. A triangle without area does not count.
struct Net {
  /// @param lines edges of the surface that are to be lines of the lattice. A boundary loop with one of them is no hole
  explicit Net(const mesh::Surface& surface, const std::vector<int>& lines = {});

  int vertex_count() const { return static_cast<int>(vertex_area.size()); }
  int triangle_count() const { return static_cast<int>(area.size()); }
  int side_count() const { return static_cast<int>(tail.size()); }

  /// The next side of the triangle, and the one before, which runs to the vertex that the side leaves.
  static int next(int side) { return side % 3 == 2 ? side - 2 : side + 1; }
  static int before(int side) { return side % 3 == 0 ? side + 2 : side - 1; }

  std::vector<int> tail, head;  ///< #sides, vertices
  std::vector<int> edge;        ///< #sides
  std::vector<int> twin;        ///< #sides, the side that runs back; -1 on the boundary
  std::vector<Complex> along;   ///< #sides, in the plane of the triangle
  /// #sides: a vector of angle a in the plane of the triangle has the angle a + transport in that of the twin's; 0 on
  /// the boundary
  std::vector<double> transport;
  std::vector<double> cotangent;    ///< #sides, half the cotangent of the opposite angle; 0 without area
  std::vector<double> weight;       ///< #sides, that of the edge: the sum of both, positive
  std::vector<double> area;         ///< #T, 0 without area
  std::vector<double> vertex_area;  ///< #V, a third of the areas around
  /// #V, what is missing of 2 pi around a vertex; on the boundary of pi. The lowest vertex of a hole has 2 pi besides:
  /// the sum over it is that of the polygon which fills it.
  std::vector<double> defect;
  std::vector<int> first;         ///< #V, a side that leaves the vertex; on the boundary the one along it; -1 for none
  std::vector<int> hole;          ///< #V, the lowest vertex of the hole that it is on, or -1
  std::vector<char> on_boundary;  ///< #V
  std::vector<char> is_line;      ///< #sides
  double whole_area = 0;
  int genus = 0;
};

/// The closed dual curves that generate the homology of the surface with its holes filled: lists of the sides that they
/// cross, 2 genus of them, and one a boundary loop but the last that is no hole.
std::vector<std::vector<int>> dual_loops(const Net& net);

}  // namespace holomorph::tiling
