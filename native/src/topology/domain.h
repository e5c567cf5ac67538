// The paper's fundamental domain D, its graph G and a spanning tree T of G (paper § 4), chosen so that loops are short.
//
// D grows face by face; each face is joined through one edge. So the edges crossed form a spanning tree C of the dual
// graph: the cotree of a tree-cotree decomposition (Eppstein 2003). G is all other edges. Its 2g edges outside T are
// the e_i. The paper takes faces from a plain queue. Here C is the spanning tree of the edges whose loops through T are
// longest (diagonals of polygons before all others, edges of T never). So the edges left over close the shortest loops.
// This is the greedy basis of Erickson and Whittlesey (2005), with T the shortest-path tree from a root.
//
// With boundary: no boundary edge is crossed. T has all edges of each loop but one, e_k. The search for shortest paths
// runs along a loop at no cost, because the surface need not be cut there. Again 2g interior edges are left over.
#pragma once

#include <vector>

#include "base/execution.h"
#include "base/page_allocator.h"
#include "mesh/components.h"
#include "mesh/stars.h"

namespace holomorph::topology {

using mesh::HalfedgeHandle;
using mesh::HalfEdges;

/// Stores T and C as pointers to parents, with the orders in which they were grown. @pre the surface is connected, and
/// every vertex has a face
struct FundamentalDomain {
  Array<HalfedgeHandle>
      to_parent_face;     ///< #T half-edge of the face across which its parent in D lies; invalid at the first
  Array<int> face_order;  ///< #T faces, each after its parent
  Array<int> face_rank;   ///< #T rank of each face in that order
  Array<char> crossed;    ///< #E 1 for the edges of C, which are inside D; the others are G
  Array<HalfedgeHandle> to_parent_vertex;  ///< #V the half-edge towards the root of T; invalid at the root
  Array<int> vertex_rank;                  ///< #V rank in an order in which each vertex is after its parent
  std::vector<int> left_over;              ///< the 2g interior edges of G outside T, ascending
  mesh::BoundaryLoops boundary;
  std::vector<HalfedgeHandle> gaps;  ///< e_k, the edge of boundary loop k outside T: the half-edge without a face
};

/// Grows the tree T of shortest paths from a root: fills in to_parent_vertex, vertex_rank and the gaps of a domain
/// whose boundary is known.
/// @return #V distances from the root along T
/// Dijkstra along edges of polygons. The first vertex of a star that is settled settles its centre and link through
/// the spokes. So does the first vertex of a boundary loop, at no cost, because the surface need not be cut along it.
/// Cost: O(n log m), with m the few vertices of a bucket.
Array<double> grow_shortest_paths(const mesh::Surface& surface, const HalfEdges& half_edges,
                                  const std::vector<mesh::Star>& stars, int root, FundamentalDomain& domain,
                                  Execution& execution);

}  // namespace holomorph::topology
