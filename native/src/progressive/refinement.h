// Replays splits: levels of a progressive mesh.
#pragma once

#include <cstddef>
#include <vector>

#include "progressive/edge_collapse.h"
#include "progressive/progressive_mesh.h"

namespace holomorph::progressive {

class Refinement {
 public:
  /// @param splits how many will be made at most
  Refinement(const ProgressiveMesh& mesh, int splits);

  /// Makes the next split. A valid mesh remains valid.
  /// @throws InvalidMesh naming the split, if v_l and v_r are not neighbours of v_s in the right order
  void split();

  /// Neighbours of v_s that became neighbours of v_t instead in the last split.
  const std::vector<int>& moved() const { return moved_; }
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
