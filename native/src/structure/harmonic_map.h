// The harmonic map in the class of a given one, at a level of a progressive mesh.
#pragma once

#include "base/execution.h"
#include "forms/closed_forms.h"
#include "mesh/surface.h"
#include "structure/options.h"
#include "structure/solver_report.h"

namespace holomorph::structure {

struct HarmonicMap {
  forms::RowMajorMatrix moves;  ///< #V x 2m, to be added to the UVs of all corners of a vertex
  structure::SolverReport solver;
};

/// Makes m UV maps harmonic, with the same periods: adds df to the forms du and dv as in Eq. 8 of the paper, with
/// L f = -d* du. That is step 5(c) of its § 9 applied to a coarser level. With a boundary, v keeps its values there and
/// u gets the natural condition, as for natural and Dirichlet forms. Free constants are chosen so that the mean of
/// `moves` is 0, each vertex weighted by a third of the area of its triangles.
/// @param corner_values #C x 2m, columns u, v, u, v, ...
/// @throws InvalidMesh naming an edge across which the map is not continued by a translation, or a boundary edge along
/// which v changes. TopologyError unless the surface is connected, with handles or two boundary loops. SolverError;
/// Cancelled
HarmonicMap harmonic_map(const mesh::Surface& surface, const forms::RowMajorMatrix& corner_values,
                         const structure::Options& options, Execution& execution);

}  // namespace holomorph::structure
