// Surfaces with poles: a differential of the third kind, and the holomorphic forms with it (paper § 11 names them).
#pragma once

#include "base/execution.h"
#include "forms/third_kind.h"
#include "structure/solver_report.h"
#include "structure/structure.h"

namespace holomorph::structure {

/// A surface with poles before anything is solved for.
struct SurfaceWithPoles {
  Structure structure;                  ///< surface, topology and poles
  mesh::Discretisation discretisation;  ///< on the triangles of the surface, its diagonals flipped
  forms::PoleForms pole_forms;
};

/// The first step of `pole_structure`, with the same arguments and errors.
SurfaceWithPoles surface_with_poles(std::shared_ptr<const mesh::Surface> surface, Poles poles, Execution& execution);

/// Cuts a structure whose stars are known: sets its topology. @param discretisation on the surface's own triangles
forms::PoleForms cut_at_poles(Structure& structure, const mesh::Discretisation& discretisation, Execution& execution);

/// Computes the structure of any connected surface with poles. The form theta_0 has the residues r_i / (2 pi i) at the
/// poles. For real residues its imaginary part is single-valued, and 0 on the boundary. The holomorphic forms of the
/// surface come after it. All of it belongs to the surface's own triangulation, its diagonals flipped away from the
/// poles: the stars stay as they are.
/// @param poles if there are none, two far apart are taken on a closed surface, and the deepest vertex on one with
/// boundary. Poles without residues have the default ones
/// @pre connected, no isolated vertices
/// @throws TopologyError for poles or residues that do not fit; SolverError; Cancelled
Structure pole_structure(std::shared_ptr<const mesh::Surface> surface, Poles poles, const Options& options,
                         Execution& execution);

}  // namespace holomorph::structure
