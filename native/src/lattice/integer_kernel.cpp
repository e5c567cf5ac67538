#include "lattice/integer_kernel.h"

#include <cstdlib>

namespace holomorph::lattice {

IntegerMatrix integer_kernel(IntegerMatrix A) {
  using Eigen::Index;
  IntegerMatrix all = IntegerMatrix::Identity(A.cols(), A.cols());
  const auto exchange = [&](Index i, Index j) {
    A.col(i).swap(A.col(j));
    all.col(i).swap(all.col(j));
  };
  // Throughout, A is the given matrix times `all`. In rows that are done, its columns from `rank` on are 0.
  Index rank = 0;
  for (Index row = 0; row < A.rows() && rank < A.cols(); ++row) {
    for (Index j = rank + 1; j < A.cols(); ++j) {
      while (A(row, j) != 0) {  // the entry falls
        const std::int64_t times = A(row, rank) / A(row, j);
        A.col(rank) -= times * A.col(j);
        all.col(rank) -= times * all.col(j);
        exchange(rank, j);
      }
    }
    if (A(row, rank) != 0) ++rank;
  }
  return all.rightCols(A.cols() - rank);
}

}  // namespace holomorph::lattice
