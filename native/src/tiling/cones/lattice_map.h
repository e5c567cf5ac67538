// Maps whose sides of a cut turn by the symmetries of a lattice: a value at each vertex, and a symmetry at each corner.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "base/constants.h"
#include "mesh/surface.h"
#include "tiling/cones/turned_space.h"
#include "uv/uv_map.h"

namespace holomorph::tiling {

/// A symmetry of the lattice in its own coordinates, w = R^turn x + translation.
struct Symmetry {
  int turn = 0;
  std::array<int, 2> translation{};
  friend bool operator==(const Symmetry&, const Symmetry&) = default;
};
/// First b, then a.
Symmetry after(const TurnLattice& lattice, const Symmetry& a, const Symmetry& b);
Symmetry inverse(const TurnLattice& lattice, const Symmetry& a);

/// The corner that a side leaves has the value of its vertex, moved by its symmetry. Across an edge symmetries of both
/// ends say how triangles continue each other.
struct LatticeMap {
  /// Counter-clockwise around a cone the triangle of this side is the first one. It continues the last one when
  /// `closing` comes before its own symmetry; that does not move the cone.
  struct Cone {
    int side;
    Symmetry closing;
  };
  std::vector<Complex> y;     ///< #V, in the plane
  std::vector<Symmetry> at;   ///< #sides
  std::map<int, Cone> cones;  ///< by vertex
};

/// Across an edge from the triangle on its left, seen from the lower vertex, to that on its right:
/// x' = R^turn x + translation, in coordinates of the lattice.
struct Jump {
  int edge = 0, turn = 0;
  std::array<std::int64_t, 2> translation{};
};

/// The UVs of polygons' corners in the plane. In coordinates of the lattice they are exact on a grid of powers of two:
/// turns are integer matrices there, and translations whole. @pre the triangles of a polygon continue each other
uv::UvArray corner_uv(const mesh::Surface& surface, const TurnLattice& lattice, const LatticeMap& map);

/// Turns and moves triangles so that those of a polygon continue each other.
void join_polygons(const mesh::Surface& surface, const TurnLattice& lattice, LatticeMap& map);

/// Moves the frames of triangles: their corners. @param by #T, k-th turns
void turn_triangles(const TurnLattice& lattice, const std::vector<int>& by, LatticeMap& map);

/// The edges across which the map jumps, ascending.
std::vector<Jump> jumps_of(const mesh::Surface& surface, const TurnLattice& lattice, const LatticeMap& map);

}  // namespace holomorph::tiling
