// Half-edge collapses on flat arrays, for both orders of collapsing. Nothing is allocated per collapse.
#pragma once

#include <cstdint>
#include <vector>

#include "base/page_allocator.h"
#include "progressive/corner_table.h"

namespace holomorph::progressive {

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
