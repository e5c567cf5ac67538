// Classes pulled back, and loops lifted, from the base of a progressive mesh to finer levels (paper § 9, step 5).
#pragma once

#include <vector>

#include "progressive/refinement.h"
#include "topology/homology.h"

namespace holomorph::topology {

/// Rule 5(b) of the paper for all splits at once. The new edge v_s v_t gets 0, and an edge of v_t gets the value of the
/// edge of v_s that it comes from. That is the pull-back by the simplicial map which takes each vertex to the one it
/// was collapsed into: w(u -> v) = w_base(m(u) -> m(v)), 0 where m(u) = m(v). Closed forms remain closed, and the
/// period over a loop is that over its image.
/// @param forms closed forms on the edges of `base`
/// @param surface a finer level, or the original
/// @param map #V of `surface`: the vertex of `base` that each one was collapsed into
IntegerForms pull_back_classes(const mesh::Surface& base, const IntegerForms& forms, const mesh::Surface& surface,
                               const std::vector<int>& map);

/// Returns for each edge of `surface` (#E) the edge e of `base` that the map takes it to: 2e along its direction, 2e +
/// 1 against it, -1 where both ends have the same image. Real forms are pulled back with it, too.
std::vector<int> base_half_edges(const mesh::Surface& base, const mesh::Surface& surface, const std::vector<int>& map);

/// Lifts closed loops of vertices of the base to the level with this many splits. Where a split separates the two
/// neighbours of v_s on a loop, the edge v_s v_t is inserted. The map above takes the lifted loops to the given ones.
/// @throws InvalidMesh if a loop has two consecutive vertices without an edge between them
std::vector<std::vector<int>> lift_loops(const progressive::ProgressiveMesh& mesh, int splits,
                                         const std::vector<std::vector<int>>& loops);

/// The handles' loops as loops of vertices; the integer classes dual to them and to the boundary loops 1 .. b-1.
struct BaseBases {
  std::vector<std::vector<int>> loops;
  IntegerForms classes;
  IntegerForms relative;         ///< relative_classes; none of a closed mesh
  mesh::BoundaryLoops boundary;  ///< none of a closed mesh
};

/// Homology and cohomology bases of a base mesh (paper § 9, steps 2 and 3).
/// @param loop_of_vertex #V the number that each vertex's boundary loop is to have, -1 in the interior; by default
/// loops are numbered as boundary_loops does. @pre connected, with harmonic forms
BaseBases base_bases(const mesh::Surface& base, const std::vector<int>& loop_of_vertex = {});

/// A homology basis and the integer classes dual to it, eta_i(zeta_j) = delta_ij exactly: `loops` of the handles, then
/// the boundary loops 1 .. b-1.
struct DualBases {
  std::vector<std::vector<HalfedgeHandle>> loops;
  IntegerForms classes;
  mesh::BoundaryLoops boundary;  ///< in the order of the classes; none of a closed surface
};

/// The bases of the base mesh on the half-edges of the level with this many splits, loops lifted and classes pulled
/// back. So all levels have the same classes, the same intersection matrix and the same canonical basis.
/// @param level the surface of that level; @pre connected, with harmonic forms
DualBases lifted_bases(const progressive::ProgressiveMesh& mesh, int splits, const mesh::Surface& level);
DualBases lifted_bases(const progressive::ProgressiveMesh& mesh, int splits, const mesh::Surface& level,
                       const BaseBases& base);

}  // namespace holomorph::topology
