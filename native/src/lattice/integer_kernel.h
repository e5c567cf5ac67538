// The integer vectors that an integer matrix takes to 0.
#pragma once

#include "lattice/reduction.h"

namespace holomorph::lattice {

/// n x k: a basis of {z in Z^n : A z = 0}, by exchanges and differences of columns (Euclid's algorithm in each row).
/// Cost: O(m n^2) for small entries, which it suits alone: they are not kept small.
IntegerMatrix integer_kernel(IntegerMatrix A);

}  // namespace holomorph::lattice
