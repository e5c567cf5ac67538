// Flat half-edges of a triangle mesh: half a cache line per triangle, changed in place, never allocated while in use.
#pragma once

#include <span>
#include <vector>

#include "base/page_allocator.h"
#include "mesh/surface.h"

namespace holomorph::progressive {

using mesh::Triple;

/// Side 4t+i of triangle t runs from its corner i to the next corner; 4t+3 is padding.
struct Side {
  int vertex;    ///< where it starts
  int opposite;  ///< the same edge in the other triangle; -1 at a boundary
};

/// Each vertex keeps one side that leaves it, at the boundary the one without an opposite. A counter-clockwise walk
/// from it visits all triangles of the vertex.
class CornerTable {
 public:
  /// @param triangles #T consistently oriented; `edges` #T edge of each side, numbers below `edge_count`
  /// @param triangle_capacity largest number of triangles
  CornerTable(std::span<const Triple> triangles, std::span<const Triple> edges, std::size_t edge_count,
              std::size_t triangle_capacity);

  static int next(int side) { return side + 1 - 3 * ((side & 3) == 2); }
  static int previous(int side) { return side - 1 + 3 * ((side & 3) == 0); }

  Side& operator[](int side) { return sides_[static_cast<std::size_t>(side)]; }
  const Side& operator[](int side) const { return sides_[static_cast<std::size_t>(side)]; }

  int from(int side) const { return (*this)[side].vertex; }
  int to(int side) const { return from(next(side)); }
  int apex(int side) const { return from(previous(side)); }
  int opposite(int side) const { return (*this)[side].opposite; }
  /// The next side that leaves the same vertex, counter-clockwise or clockwise; -1 beyond the boundary.
  int turn_left(int side) const { return opposite(previous(side)); }
  int turn_right(int side) const { return opposite(side) < 0 ? -1 : next(opposite(side)); }

  void link(int a, int b) {
    if (a >= 0) (*this)[a].opposite = b;
    if (b >= 0) (*this)[b].opposite = a;
  }
  /// The side without an opposite that leaves a boundary vertex, found from any side that leaves it.
  int first_side(int side) const {
    while (opposite(side) >= 0) side = turn_right(side);
    return side;
  }
  /// Calls each(w) for the neighbours of a vertex, counter-clockwise from the head of `start`, its kept side.
  template <class Each>
  void each_neighbour(int start, const Each& each) const {
    int side = start;
    do {
      each(to(side));
      const int left = turn_left(side);
      if (left < 0) each(apex(side));
      side = left;
    } while (side >= 0 && side != start);
  }
  /// Appends a triangle without opposites; returns its first side.
  int add(int a, int b, int c);
  int triangle_count() const { return static_cast<int>(sides_.size() / 4); }

 private:
  Array<Side> sides_;
};

/// Returns one side that leaves each of `vertex_count` vertices, as described above; -1 for a vertex of no triangle.
std::vector<int> leaving_sides(const CornerTable& table, int vertex_count);

}  // namespace holomorph::progressive
