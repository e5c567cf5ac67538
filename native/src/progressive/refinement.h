// Replays splits: levels of a progressive mesh.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "mesh/surface.h"
#include "progressive/edge_collapse.h"

namespace holomorph::progressive {

// Progressive meshes (paper § 3; Hoppe 1996, doi:10.1145/237170.237216): a small base mesh and a sequence of vertex
// splits. The splits rebuild positions, polygons and corners of the original exactly, with a valid mesh at every step.

using mesh::Triple;

/// The vertex split {v_s, v_t, v_l, v_r, A}. It adds the vertex v_t and the triangles {v_s, v_t, v_l} and {v_t, v_s,
/// v_r}. The triangles counter-clockwise from v_r to v_l around v_s move to v_t. The vertex v_s stays in place: an edge
/// collapse takes v_t to v_s.
struct Split {
  int v_s, v_l, v_r;            ///< v_l or v_r is -1 where the edge is on the boundary
  std::uint8_t slot_l, slot_r;  ///< corner of the left triangle that is v_s, of the right one that is v_t
  friend bool operator==(const Split&, const Split&) = default;
};

/// Vertices are numbered base first, then in the order of the splits, isolated vertices last. Triangles are numbered
/// base first, then in the order of the splits, the left one first. So the vertices and triangles of a level are the
/// first ones of every finer level. Polygons: this is the progressive mesh of the surface's triangulation, and each
/// corner of a triangle knows its corner of a polygon.
struct ProgressiveMesh {
  mesh::Surface base;
  std::vector<Split> splits;
  std::vector<std::array<double, 3>> positions;  ///< #V of the original, in the numbering above
  std::vector<int> vertex_index;                 ///< #V in the original
  std::vector<int> triangle_index;               ///< #T in the original surface's triangulation
  std::vector<Triple> triangle_corners;          ///< #T polygon corners; empty: triangle t has 3t, 3t+1, 3t+2
  std::vector<int> face_offsets;                 ///< offsets of the original polygons; empty: all are triangles

  int base_vertex_count() const { return base.vertex_count; }
  int vertex_count() const { return base.vertex_count + static_cast<int>(splits.size()); }  ///< without isolated ones
  int triangle_count() const { return static_cast<int>(triangle_index.size()); }
};

/// Triangles as a polygon mesh.
mesh::Polygons triangle_polygons(std::vector<std::array<double, 3>> vertices, const std::vector<Triple>& triangles);

/// Number of triangles of the level with this many splits.
std::int64_t triangle_count(const ProgressiveMesh& mesh, int splits);

/// Returns the number of splits of the finest level with at most `triangle_count` triangles; 0 if the base has more.
int split_count(const ProgressiveMesh& mesh, std::int64_t triangle_count);

/// Returns the vertex of the level that each vertex of the finest one was collapsed into: the simplicial map M -> M_k.
std::vector<int> vertex_map(const ProgressiveMesh& mesh, int splits);

/// Polygon corner of the original at each triangle corner of the numbering above; #T.
std::vector<Triple> original_corners(const ProgressiveMesh& mesh);

class Refinement {
 public:
  /// @param splits how many will be made at most
  Refinement(const ProgressiveMesh& mesh, int splits);

  /// Makes the next split. A valid mesh remains valid.
  /// @throws InvalidMesh naming the split, if v_l and v_r are not neighbours of v_s in the right order
  void split();

  /// Neighbours of v_s that became neighbours of v_t instead in the last split.
  const std::vector<int>& moved() const { return moved_; }

  /// What the last split did: sides are those of a CornerTable.
  struct Last {
    int from = 0, to = 0;     ///< the sides from .. to-1 of the star moved to v_t; a closed star is a ring
    int left = 0, right = 0;  ///< v_s -> v_t and v_t -> v_s in the new triangles; -1 for none
  };
  const Last& last() const { return last_; }
  /// The sides that left v_s before the last split, counter-clockwise.
  const std::vector<int>& star_sides() const { return star_sides_; }
  /// Their ends; one more where v_s was on the boundary.
  const std::vector<int>& star_vertices() const { return star_vertices_; }
  int splits_made() const { return made_; }
  std::vector<Triple> triangles() const;

 private:
  // The triangles from .. to-1 of the star of v_s, which move to v_t.
  struct Sector {
    int from, to;
    bool closed;  // no boundary at v_s
  };
  void require(bool valid, const char* what) const;
  void find_star(int v);
  void check_vertices(const Split& split, int t) const;
  Sector sector_of(const Split& split, int t) const;
  int leaving(int i, bool closed) const;
  int arriving(int i, bool closed) const;
  void move(const Sector& sector, const Split& split, int t);
  int add(int a, int b, int c, int slot, int c_to_b, int a_to_c);
  void set_first_sides(const Sector& sector, const Split& split, int left, int right);

  const ProgressiveMesh& mesh_;
  CornerTable table_;
  std::vector<int> leaving_;
  std::vector<int> star_sides_, star_vertices_;  // around v_s, counter-clockwise
  std::vector<int> moved_;
  Last last_;
  int made_ = 0;
};

/// Returns a level as polygons, in the numbering of the progressive mesh. @param splits from 0 to all
mesh::Polygons level(const ProgressiveMesh& mesh, int splits);

/// Returns the original polygons, bit for bit, rebuilt from the base by all the splits.
mesh::Polygons restored(const ProgressiveMesh& mesh);

// The checks of progressive meshes that come from elsewhere: arrays of a file, records.

/// Makes the base from its triangles and the first positions. @throws InvalidMesh if it is not a valid mesh, has
/// isolated vertices, or is not oriented consistently
void set_base(ProgressiveMesh& mesh, const std::vector<Triple>& triangles, std::size_t vertex_count);

/// Checks counts, permutations, corners and every split. If it returns, the levels and the original are valid meshes.
/// @throws InvalidMesh naming what is wrong
void check(const ProgressiveMesh& mesh);

}  // namespace holomorph::progressive
