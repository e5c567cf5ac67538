// The weights of the Laplacian in double precision, kept as what single precision leaves of them.
#pragma once

#include "base/execution.h"
#include "solver/cycle_level.h"
#include "solver/laplacian.h"
#include "solver/sparse_rows.h"

namespace holomorph::solver {

/// For each entry of the finest operator A, in its order, the rest: -L_ij = weight + rest up to 2^-48 of it. A quarter
/// of the memory of L, which is not needed beside them.
/// @param A of finest_operator(L)
/// @throws Cancelled
Array<float> weight_rests(const Laplacian& L, const SparseRows& A, Workers& workers, Execution& execution);

/// The Laplacian that they stand for, its diagonal summed up anew. Cost: linear, one thread.
Laplacian laplacian_of(const CycleLevel& finest, const Array<float>& rests);

}  // namespace holomorph::solver
