// The matrix of the linear systems, as every solver takes it.
#pragma once

#include <Eigen/SparseCore>

#include "base/page_allocator.h"

namespace holomorph::solver {

/// The cotan Laplacian L of a connected surface: symmetric, both triangles stored, positive semi-definite; its kernel
/// is the constants. Stored row by row, which is the same as column by column. Its arrays are on large pages, and moved
/// without a copy, as a sparse matrix of Eigen's (3.4) is not.
struct Laplacian {
  Array<int> starts;      ///< #V + 1, where each row begins, and the end of the last
  Array<int> columns;     ///< ascending in each row, the diagonal among them
  Array<double> weights;  ///< weights of the same entries

  int size() const { return starts.empty() ? 0 : static_cast<int>(starts.size()) - 1; }

  using Matrix = Eigen::SparseMatrix<double>;
  /// The same as a matrix of Eigen's, without a copy.
  Eigen::Map<const Matrix> matrix() const {
    const auto entries = static_cast<Eigen::Index>(columns.size());
    return {size(), size(), entries, starts.data(), columns.data(), weights.data()};
  }
};

}  // namespace holomorph::solver
