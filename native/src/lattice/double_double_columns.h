// Columns of numbers in twice the working precision.
#pragma once

#include <Eigen/Core>

#include "base/double_double.h"

namespace holomorph::lattice {

struct DoubleDoubleColumns {
  Eigen::MatrixXd high, low;

  /// Does column(k) -= factor * column(j), for a factor that is exact. Error: some 1e-32 of the larger term.
  void subtract(Eigen::Index k, double factor, Eigen::Index j) {
    const auto [f, g] = halves(factor);
    double *h = high.col(k).data(), *l = low.col(k).data();
    const double *a = high.col(j).data(), *b = low.col(j).data();
    for (Eigen::Index i = 0; i < high.rows(); ++i) {
      const auto [u, v] = halves(a[i]);
      const double product = factor * a[i], product_error = ((f * u - product) + f * v + g * u) + g * v;
      const double sum = h[i] - product, taken = h[i] - sum;
      const double sum_error = (h[i] - (sum + taken)) + (taken - product);
      const double rest = l[i] + (sum_error - product_error - factor * b[i]);
      h[i] = sum + rest;
      l[i] = rest - (h[i] - sum);
    }
  }

  void swap(Eigen::Index k, Eigen::Index j) {
    high.col(k).swap(high.col(j));
    low.col(k).swap(low.col(j));
  }
};

}  // namespace holomorph::lattice
