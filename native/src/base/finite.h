// Checks arrays of coordinates before they leave the library.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <string>

#include "base/chunks.h"
#include "base/errors.h"

namespace holomorph {

/// @param rows real or complex, @param what the rows are of, e.g. "corner"
/// @throws SolverError naming the first row that is not finite. Cost: linear, in parallel.
template <class Derived>
void require_finite(const Eigen::DenseBase<Derived>& rows, const char* what, Workers& workers) {
  const int count = static_cast<int>(rows.rows());
  const int bad = first_row(workers, count, [&](int i) { return !rows.row(i).allFinite(); });
  if (bad == count) return;
  throw SolverError(std::string("the map has no finite coordinates at ") + what + " " + std::to_string(bad) +
                    ": the mesh is too degenerate there");
}

}  // namespace holomorph
