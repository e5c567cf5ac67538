// Plain conjugate gradients for several right-hand sides side by side (Hestenes & Stiefel 1952).
#pragma once

#include "solver/laplace_solver.h"

namespace holomorph::solver {

enum class Scaling {
  none,     ///< the textbook's method, as the paper names it
  diagonal  ///< the diagonal of L is scaled to ones: Jacobi's preconditioner
};

struct GradientOptions {
  Scaling scaling = Scaling::diagonal;
  double residual = kResidual;  ///< |B - L X| <= residual |B| is asked for, for every right-hand side
  int most_iterations = 100'000;
};

struct GradientReport {
  int iterations = 0;
  double residual = 0;  ///< largest |B - L X| / |B| reached, computed anew at the end
  bool converged = false;
  bool is_rounding = false;  ///< for every right-hand side, no more is left than rounding of |L| |X| + |B|
};

/// Improves X until the residual is reached, beginning with the values that it has. The constants, the kernel of L, are
/// taken out of the residual, and X is determined up to them. Up to 8 right-hand sides go through one pass over the
/// matrix, each with coefficients of its own.
/// @param B,X #V x #rhs
/// @throws Cancelled, asked at every iteration
/// Cost: three passes over the vertices per iteration; the bits do not depend on the number of threads.
GradientReport conjugate_gradients(const Laplacian& L, const Eigen::MatrixXd& B, Eigen::MatrixXd& X,
                                   const GradientOptions& options, Execution& execution);

}  // namespace holomorph::solver
