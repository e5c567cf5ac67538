// Several right-hand sides side by side: how columns are cut into blocks, quotients of their norms, and progress.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <type_traits>

namespace holomorph::solver {

/// The part of the terms of B - L X, |L| |X| + |B|, up to which a residual is rounding: a few dozen rounding errors.
inline constexpr double kRoundingOfTerms = 1e-14;

/// Calls solve(K, begin, end) with a constant K for the columns begin .. end-1: blocks of 8, and at the end one of 4 or
/// 2 where that is enough.
template <class Solve>
void for_column_blocks(Eigen::Index columns, const Solve& solve) {
  const Eigen::Index over = columns % 8, in_eights = columns - (over <= 4 ? over : 0);
  if (in_eights > 0) solve(std::integral_constant<int, 8>(), Eigen::Index{0}, in_eights);
  if (in_eights == columns) return;
  if (over <= 2) {
    solve(std::integral_constant<int, 2>(), in_eights, columns);
  } else {
    solve(std::integral_constant<int, 4>(), in_eights, columns);
  }
}

/// a / b where b > 0, else 0: a right-hand side that is solved exactly stays as it is.
template <int K>
Eigen::Array<double, K, 1> quotient(const Eigen::Array<double, K, 1>& a, const Eigen::Array<double, K, 1>& b) {
  return (b > 0).select(a / b, 0.0);
}

/// The largest relative residual, given norms of residuals and of right-hand sides; NaN where one is.
template <class Norms>
double largest_relative(const Norms& residuals, const Norms& norms) {
  double worst = 0;
  for (Eigen::Index d = 0; d < norms.size(); ++d) {
    const double ratio = norms[d] > 0 ? residuals[d] / norms[d] : residuals[d];
    if (!(ratio <= worst)) worst = ratio;  // std::max would drop a NaN
  }
  return worst;
}

/// Part of the digits down to the relative residual `goal` that are reached, in [0, 1]: how far a solve has come.
inline double part_of_digits(double reached, double goal) {
  return std::clamp(std::log10(reached) / std::log10(goal), 0.0, 1.0);
}

}  // namespace holomorph::solver
