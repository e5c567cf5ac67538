// What is known of a surface from its triangles alone, in exact integers (paper § 4, § 5).
#pragma once

#include <optional>
#include <vector>

#include "base/execution.h"
#include "forms/closed_forms.h"
#include "mesh/components.h"
#include "topology/homology.h"
#include "topology/pulled_back_classes.h"
#include "uv/uv_map.h"

namespace holomorph::structure {

/// The families of a basis of harmonic forms, in the order of its forms.
struct Families {
  int natural = 0;    ///< dual to the homology basis, d* h = 0 at every vertex
  int dirichlet = 0;  ///< with boundary as many: zero along the boundary. The 2g handle classes, then the harmonic
                      ///< measures of the loops 1 .. b-1
  int poles = 0;      ///< pairs of the third kind: u_1 .. u_k, then v_1 .. v_k

  int harmonic() const { return natural + dirichlet; }
  int count() const { return harmonic() + 2 * poles; }
};

struct Topology {
  mesh::TopologicalType type;
  mesh::BoundaryLoops boundary;                                   ///< none on a closed surface
  std::vector<std::vector<mesh::HalfedgeHandle>> homology_basis;  ///< 2g loops zeta_i, then boundary loops 1 .. b-1
  topology::IntegerMatrix pairing;     ///< W_ij = int h_i ^ h^D_j, |det| 1; closed: the wedge matrix; with boundary
                                       ///< [[J_h, 0], [X, 1]]
  topology::CanonicalBasis canonical;  ///< only on a closed surface with handles
  Families families;
  topology::IntegerForms classes;  ///< classes of the whole basis, on the edges of the surface
  std::vector<int> seams;          ///< edges of the cut graph, and of the spokes of poles
  uv::CoveringSheets sheets;       ///< integer potentials of the classes
};

/// Finds fundamental domain, homology basis, dual classes, pairing and cut.
/// @param given lifted loops and pulled-back dual classes of a progressive mesh's base
/// @param stars of poles
/// @pre connected, no isolated vertices
/// @throws Cancelled. Cost: near-linear; see topology::fundamental_domain
Topology find_topology(const mesh::Surface& surface, const mesh::HalfEdges& half_edges, Execution& execution,
                       std::optional<topology::DualBases> given = {}, const std::vector<mesh::Star>& stars = {});

/// Returns the classes whose harmonic forms are solved for, on any triangulation of the same vertices. They are the
/// natural ones, and with boundary the Dirichlet ones: those of the handles and d(1 on loop k, 0 elsewhere).
/// @param half_edges,flips of that triangulation, flipped from the surface's own
topology::IntegerForms classes_on(const Topology& topology, const mesh::HalfEdges& half_edges,
                                  const std::vector<mesh::Flip>& flips);

/// Adds 1 on boundary loop k to the function of its Dirichlet form, whose class in `Topology::classes` is 0. The
/// results are the harmonic measures of the loops.
void add_loop_indicators(const Topology& topology, Eigen::Ref<forms::RowMajorMatrix> functions);

}  // namespace holomorph::structure
