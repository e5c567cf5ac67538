// The double of a surface as something to solve on: the paper's own path to forms with boundary (§ 8).
#pragma once

#include "base/execution.h"
#include "forms/closed_forms.h"
#include "mesh/discretisation.h"
#include "mesh/double_cover.h"

namespace holomorph::structure {

struct DoubledSurface {
  mesh::DoubleCover cover;
  Array<double> weights;  ///< #E of the double, those of the surface: edges of the boundary count twice
};

DoubledSurface doubled(const mesh::Discretisation& surface, Execution& execution);

/// Extends classes to the double: the first `natural` ones symmetrically, the others antisymmetrically.
topology::IntegerForms extended(const mesh::HalfEdges& half_edges, const mesh::DoubleCover& cover,
                                const topology::IntegerForms& classes, int natural);

/// Computes (f(v) + f(v*)) / 2 for the first `natural` functions, (f(v) - f(v*)) / 2 for the others, v* the dual vertex
/// (Eq. 12): #V of the surface x #forms.
forms::RowMajorMatrix symmetrised(const forms::RowMajorMatrix& functions, const mesh::DoubleCover& cover, int natural);

}  // namespace holomorph::structure
