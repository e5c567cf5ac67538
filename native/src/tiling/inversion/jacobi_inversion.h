// Jacobi inversion: moves the poles of a form until it is holomorphic although its periods are integers.
#pragma once

#include <functional>
#include <vector>

#include "tiling/inversion/abel_jacobi.h"

namespace holomorph::tiling {

/// Poles at vertices. C there is known modulo integers; `parts` are the representatives that the periods refer to.
struct LiftedPoles {
  std::vector<int> vertices;
  std::vector<VectorXd> parts;  ///< C at each, 2g
};

struct MoveOptions {
  std::vector<char> allowed;   ///< #V, empty: anywhere
  double farthest = 0.12;      ///< how far a pole may go, in square roots of the area
  std::vector<char> held;      ///< #poles, 1 for poles that stay at their vertices; empty: none
  std::function<void()> tick;  ///< called for each step; it may throw
};

/// Moves the poles of a closed surface with handles.
struct JacobiInversion {
  /// @pre the basis outlives this. @throws Cancelled
  JacobiInversion(const PoleBasis& surface, Execution& execution)
      : basis(surface), abel_jacobi(surface, execution), jacobian(surface) {}

  const PoleBasis& basis;
  const AbelJacobi abel_jacobi;
  const Jacobian jacobian;

  /// Returns the covariance, g x g, of the t that moving these poles by about 1 can cancel.
  MatrixXcd reach(const std::vector<int>& vertices, const VectorXcd& residues) const;

  /// Moves the poles anywhere on the surface by Newton's method until t vanishes, or is as small as it becomes. Then
  /// places one pole after the other at its nearest vertex, the one that moves t most first, and lets the others
  /// follow. At last exchanges pairs of poles for better pairs of vertices near them.
  /// @param metric g x g, R with |R t| the rms Beltrami coefficient. @throws SolverError as AbelJacobi does
  LiftedPoles moved(LiftedPoles poles, const VectorXcd& periods, const VectorXcd& residues, const MatrixXcd& metric,
                    const MoveOptions& options) const;
};

}  // namespace holomorph::tiling
