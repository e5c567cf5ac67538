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

/// The symmetric extension of the first `natural` classes to the double, and the antisymmetric one of the others.
topology::IntegerForms extended(const mesh::HalfEdges& half_edges, const mesh::DoubleCover& cover,
                                const topology::IntegerForms& classes, int natural);

/// (f(v) + f(v*)) / 2 of the first `natural` functions, (f(v) - f(v*)) / 2 of the others, v* the dual vertex (Eq. 12):
/// #V of the surface x #forms.
forms::RowMajorMatrix symmetrised(const forms::RowMajorMatrix& functions, const mesh::DoubleCover& cover, int natural);

}  // namespace holomorph::structure
