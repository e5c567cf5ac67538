// Integer classes and loops carried from the base of a progressive mesh to finer levels (paper § 9, step 5).
#pragma once

#include <span>
#include <vector>

#include "progressive/progressive_mesh.h"
#include "topology/homology.h"

namespace holomorph::topology {

/// Rule 5(b) of the paper for all splits at once: the new edge v_s v_t gets 0, and an edge of v_t the value of the edge
/// of v_s that it comes from. That is the pull-back by the simplicial map which takes each vertex to the one it was
/// collapsed into: w(u -> v) = w_base(m(u) -> m(v)), 0 where m(u) = m(v). So closed forms stay closed, and the period
/// over a loop is that over its image.
/// @param forms closed forms on the edges of `base`
/// @param surface a finer level, or the original
/// @param map #V of `surface` vertex of `base`
IntegerForms carry_classes(const mesh::Surface& base, const IntegerForms& forms, const mesh::Surface& surface,
                           const std::vector<int>& map);

/// The edge between two vertices, -1 if there is none. @param edges lower end first, in lexicographic order
int edge_between(std::span<const mesh::Pair> edges, int a, int b);

/// #E of `surface` edge of `base` on which each of its edges comes to lie, as 2e or, against its direction, 2e + 1; -1
/// where its ends come together. By it real forms are carried too.
std::vector<int> base_half_edges(const mesh::Surface& base, const mesh::Surface& surface, const std::vector<int>& map);

/// Closed loops of vertices of the base as loops of the level with this many splits: where v_s is split between the two
/// neighbours of it on a loop, the edge v_s v_t is inserted. Their images under the map above are the given loops.
/// @throws InvalidMesh if a loop has two consecutive vertices without an edge between them
std::vector<std::vector<int>> carry_loops(const progressive::ProgressiveMesh& mesh, int splits,
                                          const std::vector<std::vector<int>>& loops);

/// A homology basis and the integer classes dual to it: eta_i(zeta_j) = delta_ij exactly.
struct DualBases {
  std::vector<std::vector<HalfedgeHandle>> loops;
  IntegerForms classes;
};

/// The bases of the base mesh, carried to the level with this many splits, on its half-edges. So all levels have the
/// same classes, the same intersection matrix and the same canonical basis.
/// @param level the surface of that level; @pre connected, closed, genus at least 1
DualBases carried_bases(const progressive::ProgressiveMesh& mesh, int splits, const mesh::Surface& level);

}  // namespace holomorph::topology
