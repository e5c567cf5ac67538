// Which vertices become poles, with which residues.
#pragma once

#include <complex>
#include <vector>

#include "base/execution.h"
#include "mesh/half_edges.h"

namespace holomorph::structure {

/// theta has the residue residues[i] / (2 pi i) at vertices[i]: UV changes by residues[i] around it, counter-clockwise.
struct Poles {
  std::vector<int> vertices;
  std::vector<std::complex<double>> residues;
  std::vector<int> labels;  ///< #V what a vertex is called in messages; empty: its index
};

/// Finds two vertices far apart. Takes the vertex farthest from vertex 0 along the edges, then the one farthest from
/// that, and goes on as long as the distance grows. Their stars are apart; ties go to the lower index.
/// @throws TopologyError if no two stars are apart
std::vector<int> far_apart(const mesh::Surface& surface, const mesh::HalfEdges& half_edges);

/// Finds the vertex farthest from the boundary, along edges, among those whose star does not touch the boundary.
/// @throws TopologyError if there is none
int deepest_vertex(const mesh::Surface& surface, const mesh::HalfEdges& half_edges);

/// Returns the default residues: 1 and -1 for two poles of a closed surface. For more poles, the one with the largest
/// sum of distances to the others takes minus the number of the others, which have 1. With a boundary all have 1.
/// @throws Cancelled
/// Cost: for more than two poles of a closed surface, a search over the whole surface from each.
std::vector<std::complex<double>> default_residues(const mesh::Surface& surface, const mesh::HalfEdges& half_edges,
                                                   const std::vector<int>& vertices, bool closed, Execution& execution);

/// @throws TopologyError for vertices repeated or out of range, and for another number of residues than poles. A
/// residue must be finite and not 0. A closed surface needs two poles at least, and residues that sum to 0
void check_poles(const Poles& poles, int vertex_count, bool closed);

}  // namespace holomorph::structure
