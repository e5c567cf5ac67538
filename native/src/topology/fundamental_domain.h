// Finds the fundamental domain of a surface, and cuts it open (paper § 4).
#pragma once

#include <vector>

#include "base/execution.h"
#include "topology/domain.h"

namespace holomorph::topology {

/// Finds the fundamental domain of a connected surface.
/// @param surface,half_edges the input triangulation; C has all its diagonals, so G and T consist of edges of polygons
/// @param stars of poles, all of whose spokes are in T. C enters each face of a star across its link edge, as a leaf.
/// So the surface is cut as if the stars were holes. @pre no spoke is a diagonal.
/// Cost: linear, apart from the queue of T (grow_shortest_paths) and the sort of the edges that the dual loops cross.
FundamentalDomain fundamental_domain(const mesh::Surface& surface, const HalfEdges& half_edges, Execution& execution,
                                     const std::vector<mesh::Star>& stars = {});

/// Returns the boundary of D after step 3 of the paper: the half-edges around it in order, D on their left. Pairs h, -h
/// that follow each other are removed. Without stars these are the edges of the cut graph, twice, and those of the
/// boundary, once.
std::vector<HalfedgeHandle> domain_boundary(const HalfEdges& half_edges, const FundamentalDomain& domain);

/// Returns the cut graph: the interior edges of G without its dangling ends, ascending. Cutting the surface along it
/// leaves a disk.
/// @param ends vertices to which dangling ends are kept
std::vector<int> cut_graph(const HalfEdges& half_edges, const FundamentalDomain& domain,
                           const std::vector<int>& ends = {});

}  // namespace holomorph::topology
