// Half-edge collapses on flat arrays, for both orders of collapsing. Nothing is allocated per collapse.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/page_allocator.h"
#include "mesh/surface.h"

namespace holomorph::progressive {

// Flat half-edges of a triangle mesh: half a cache line per triangle, changed in place, never allocated while in use.

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

/// A vertex v, in one cache line. The quadric Q(x) = d.A d + 2 b.d + c, d = x - position, sums area times squared
/// distance over the planes of the triangles that v stands for. It is taken about v itself, so that single precision is
/// enough.
struct alignas(64) Vertex {
  float position[3];  ///< in [-1, 1]
  float c;            ///< Q(position)
  float A[6];         ///< xx, xy, xz, yy, yz, zz
  float b[3];
  int side;  ///< leaves v; see CornerTable
  int next;  ///< in its bucket of the queue; kNowhere if it is in none, kWaiting between queue and visit
  std::uint32_t flags;
  static constexpr std::uint32_t kBoundary = 1, kRemoved = 2, kTouched = 4, kKept = 8;
  static constexpr int kNowhere = -2, kWaiting = -3;
};

/// All that undoes a collapse: the paper's record, and the two triangles, -1 where there is none.
struct Collapse {
  int v_s, v_t, v_l, v_r;
  int left, right;  ///< sides v_s -> v_t and v_t -> v_s
};

enum class Geometry { checked, ignored };

class EdgeCollapse {
 public:
  explicit EdgeCollapse(const mesh::Surface& surface);

  /// Adds the quadrics of all triangles, and of planes that stand on the boundary.
  void compute_quadrics();

  /// Gathers the star of v; the functions below are about this star.
  void gather(int v);
  int neighbour_count() const { return neighbour_count_; }
  int neighbour(int i) const { return neighbours_[i]; }
  /// Whether the boundary permits that v is collapsed into neighbour i: any neighbour, or the two along the boundary.
  bool along_boundary(int i) const { return closed_ || i == 0 || i == neighbour_count_ - 1; }
  float squared_length(int i) const { return x_[i] * x_[i] + y_[i] * y_[i] + z_[i] * z_[i]; }
  /// Q_v + Q_u at the neighbour's position, plus a small multiple of area times squared length, which decides where all
  /// is flat: towards short edges.
  float quadric_error(int i) const;
  /// Whether the complex remains a surface of the same topology (Dey et al. 1999). v and u have no common neighbours
  /// but the apexes of the triangles at their edge, where the boundary counts as one vertex. They are not two corners
  /// of a tetrahedron.
  bool keeps_topology(int i);
  /// Whether no normal of a triangle of the star rotates by more than 75 degrees.
  bool keeps_normals(int i) const;

  /// Fraction of the vertices removed: nearly 1 at the end.
  double removed_fraction() const {
    return static_cast<double>(collapses_.size()) / static_cast<double>(vertices_.size());
  }

  /// Collapses v into neighbour i.
  void collapse(int i);
  /// Makes the neighbour's quadric the sum of both; to be called before `collapse`.
  void add_quadrics(int i);

  Vertex& vertex(int v) { return vertices_[static_cast<std::size_t>(v)]; }
  int vertex_count() const { return static_cast<int>(vertices_.size()); }
  const std::vector<Collapse>& collapses() const { return collapses_; }
  void reserve(std::size_t collapses) { collapses_.reserve(collapses); }

  /// Prefetches what `gather` will read for each of these vertices: walks around several vertices wait for memory
  /// together.
  void prefetch_stars(const int* v, int count) const;

 private:
  bool boundary(int v) const { return (vertices_[static_cast<std::size_t>(v)].flags & Vertex::kBoundary) != 0; }
  bool is_neighbour(int w) const;
  // Where a triangle was removed: its apex, and sides that leave the apex and v_s there.
  struct Gap {
    int apex = -1, from_apex = -1, from_base = -1;
    bool has_opposite = false;  // whether a triangle was across the side that ends at v_s
  };
  Gap remove_triangle(int side);
  void keep_side(int v, int side);
  void grow();

  CornerTable table_;
  Array<Vertex> vertices_;
  std::vector<Collapse> collapses_;
  // The star of v: triangle i lies between neighbours i and i + 1, counter-clockwise; open at the boundary.
  int v_ = -1, triangle_count_ = 0, neighbour_count_ = 0;
  bool closed_ = true;
  std::uint64_t signature_ = 0;  // which residues modulo 64 the neighbours have
  std::vector<int> sides_, neighbours_;
  std::vector<float> x_, y_, z_;  // neighbours relative to v
};

}  // namespace holomorph::progressive
