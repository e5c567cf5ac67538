// The integer vectors that an integer matrix takes to 0.
#pragma once

#include "lattice/reduction.h"

namespace holomorph::lattice {

/// Returns a basis of {z in Z^n : A z = 0}, n x k, by exchanges and differences of columns (Euclid's algorithm in each
/// row).
/// Cost: O(m n^2) for small entries. It suits only these: entries may grow on the way.
IntegerMatrix integer_kernel(IntegerMatrix A);

}  // namespace holomorph::lattice
