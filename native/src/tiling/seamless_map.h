// From periods and residues on the lattice to the UV map that has them.
#pragma once

#include <complex>
#include <memory>
#include <vector>

#include "base/execution.h"
#include "structure/structure.h"
#include "tiling/rounding.h"

namespace holomorph::tiling {

/// The natural classes of `old` over the loops of `s`, a structure of the same polygons: integers, #loops x #loops.
Eigen::MatrixXd change_of_basis(const topology::IntegerForms& old, const structure::Structure& s);

/// The form whose periods are points of the lattice.
struct SeamlessForm {
  Eigen::VectorXcd periods;       ///< over the homology basis of its structure
  Eigen::VectorXcd coefficients;  ///< of the harmonic forms
};

/// @param X periods besides the poles, over the homology basis of `s`; with boundary c. What they differ by from points
/// of the lattice is taken away
/// @param r residues of the pole forms of `s`
/// @param straight u of the loops of a boundary is rounded alone
SeamlessForm seamless_form(const structure::Structure& s, const Eigen::VectorXcd& X, const Eigen::VectorXcd& r,
                           const TextureLattice& lattice, bool straight);

/// #V x 2: the function of the form, from those of the forms of `s`.
uv::UvArray function_of(const structure::Structure& s, const SeamlessForm& form, Execution& execution);

/// #C x 2: the UVs of the form with this function, moved by whole tiles to the middle of the plane, and on a grid of
/// powers of two that single precision holds: so the two sides of a cut differ by their jump there, too, exactly.
uv::UvArray seamless_uv(const structure::Structure& s, const SeamlessForm& form, uv::UvArray function,
                        Execution& execution);

}  // namespace holomorph::tiling
