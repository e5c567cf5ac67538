// From the base mesh to finer ones, vertex split by vertex split.
#pragma once

#include <vector>

#include "progressive/corner_table.h"
#include "progressive/progressive_mesh.h"

namespace holomorph::progressive {

class Refinement {
 public:
  /// @param splits how many will be made at most
  Refinement(const ProgressiveMesh& mesh, int splits);

  /// Makes the next split. A valid mesh stays valid: what could spoil it is refused.
  /// @throws InvalidMesh naming the split, if its vertices are no edges at v_s in the right order
  void split();

  /// Neighbours of v_s that became neighbours of v_t instead in the last split.
  const std::vector<int>& moved() const { return moved_; }
  int splits_made() const { return made_; }
  std::vector<Triple> triangles() const;

 private:
  void find_star(int v);

  const ProgressiveMesh& mesh_;
  CornerTable table_;
  std::vector<int> leaving_;
  std::vector<int> star_sides_, star_vertices_;  // around v_s, counter-clockwise
  std::vector<int> moved_;
  int made_ = 0;
};

}  // namespace holomorph::progressive
