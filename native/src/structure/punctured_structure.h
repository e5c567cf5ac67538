// Surfaces with punctures: a differential of the third kind, and the holomorphic forms with it (paper § 11 names them).
#pragma once

#include <span>

#include "base/execution.h"
#include "forms/third_kind.h"
#include "structure/options.h"
#include "structure/structure.h"

namespace holomorph::structure {

/// A surface with punctures before anything is solved for.
struct PuncturedSurface {
  Structure structure;         ///< surface, topology, punctures and stars
  mesh::HalfEdges half_edges;  ///< of the surface with its diagonals flipped
  Array<double> weights;       ///< #E
  Array<double> errors;        ///< mesh::energy_errors
  forms::Poles poles;
};

/// What `punctured_structure` begins with; the same arguments and errors.
PuncturedSurface punctured_surface(std::shared_ptr<const mesh::Surface> surface, Punctures punctures,
                                   Execution& execution);

/// The topology of a structure whose stars are known.
/// @param lengths, weights #E, of the surface's own triangulation
forms::Poles cut_at_punctures(Structure& structure, const mesh::HalfEdges& half_edges, std::span<const double> lengths,
                              const Array<double>& weights, Execution& execution);

/// Of any connected surface. theta_0 has the residues r_i / (2 pi i) at the punctures; for real residues its imaginary
/// part is single-valued, and 0 on the boundary. The holomorphic forms of the surface come after it.
/// All of it belongs to the surface's own triangulation, its diagonals flipped away from the punctures: the stars stay
/// as they are.
/// @param punctures without any two far apart are taken on a closed surface, the deepest vertex on one with boundary;
/// without residues the default ones
/// @pre connected, no isolated vertices
/// @throws TopologyError for punctures or residues that do not fit; SolverError; Cancelled
Structure punctured_structure(std::shared_ptr<const mesh::Surface> surface, Punctures punctures, const Options& options,
                              Execution& execution);

}  // namespace holomorph::structure
