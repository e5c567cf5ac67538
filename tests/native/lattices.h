// Lattices for the tests, all with integer bases: what is derived from them is known exactly.
#pragma once

#include "linear/reduction.h"

namespace holomorph::linear {

/// Entries from -largest to largest, the same for the same seed everywhere.
IntegerMatrix random_integers(Eigen::Index rows, Eigen::Index columns, std::int64_t largest, unsigned seed);

/// Another basis of the same lattice: the columns' multiples are added to each other at random.
IntegerMatrix scrambled(IntegerMatrix basis, unsigned seed);

IntegerMatrix checkerboard_lattice(
    Eigen::Index n);       ///< D_n: integers of even sum; its least vectors have length sqrt(2)
IntegerMatrix twice_e8();  ///< 2 E_8: 240 least vectors of length 2 sqrt(2)

/// The unit matrix above one row of random numbers: short combinations are linear relations between them.
IntegerMatrix knapsack(Eigen::Index n, std::int64_t largest, unsigned seed);

/// n columns: q e_i for the first half, random ones modulo q with a unit matrix below for the second.
IntegerMatrix modular_lattice(Eigen::Index n, std::int64_t q, unsigned seed);

/// Random columns of very different lengths: numbers below 2^bits, those of a column multiplied by a power of 2 up to
/// 2^40 and below 2^61 / 2^bits. With many bits their combinations do not fit doubles.
IntegerMatrix badly_scaled(Eigen::Index rows, Eigen::Index columns, int bits, unsigned seed);

/// Geometric mean of |b_k| / R_kk: the n-th root of the orthogonality defect.
double mean_defect(const Eigen::MatrixXd& basis);

}  // namespace holomorph::linear
