// Harmonic forms for the artist's triangles.
#pragma once

#include "pipeline/bounded_structure.h"
#include "pipeline/conformal_structure.h"

namespace holomorph::pipeline {

/// The harmonic representatives of the same classes on the artist's own triangulation, for UVs.
///
/// Invariants are sharpest on the intrinsic Delaunay triangulation, but its functions are linear on other triangles
/// than the artist's: across a sliver the UVs made of them may collapse or turn over. The functions here have the least
/// conformal energy on the triangles that the UVs are drawn on. Where the intrinsic functions come within 1e-9 of that
/// (relative; their energy on the artist's triangles bounds the gain from above), they are taken as they are.
/// @throws SolverError, Cancelled
HarmonicForms artist_forms(const mesh::Surface& surface, const ConformalStructure& structure, const Options& options,
                           Progress& progress);
HarmonicForms artist_forms(const mesh::Surface& surface, const BoundedStructure& structure, const Options& options,
                           Progress& progress);

}  // namespace holomorph::pipeline
