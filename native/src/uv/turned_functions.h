// What evening keeps, and functions on vertices that turn from corner to corner, some of whose parts are one unknown.
#pragma once

#include <Eigen/SparseCore>
#include <deque>
#include <functional>
#include <vector>

#include "base/execution.h"
#include "base/page_allocator.h"
#include "base/workers.h"
#include "mesh/surface.h"
#include "solver/direct/sparse_cholesky.h"
#include "uv/strain_energy.h"

namespace holomorph::uv {

// The descent of the strain energy, on the whole surface or on a patch.

/// The second derivatives of the energy are about twice the Laplacian of StrainEnergy.
inline constexpr double kInverse = 0.5;

/// Applies an approximate inverse of the second derivatives, symmetric and positive.
using Precondition = std::function<Function(const Function& gradient)>;

/// A descent of StrainEnergy. While the energy falls quickly, each step of gradient descent makes its own
/// preconditioner. Later the last one serves several steps.
class Descent {
 public:
  /// @param make makes the preconditioner at delta. @param clear sets a function to 0 at its fixed vertices
  /// @pre the energy outlives this
  Descent(const StrainEnergy& energy, double lambda, std::function<Precondition(const Function& delta)> make,
          std::function<void(Function&)> clear, Workers& workers)
      : energy_(energy), lambda_(lambda), make_(std::move(make)), clear_(std::move(clear)), workers_(workers) {}

  /// Begins anew, also where the energy itself has changed.
  StrainEnergy::Value begin(Function delta);
  /// Makes one step. @return whether to go on: false near the minimum, where a step lowers the energy by little
  bool step();

  const Function& delta() const { return delta_; }
  const StrainEnergy::Value& value() const { return value_; }

 private:
  struct Step {
    Function step, change;  // what was added to delta, and by what that changed the gradient
    double curvature;       // their product
  };

  StrainEnergy::Value at(const Function& delta, Function& gradient);
  Function direction() const;
  void take(Function step, Function change);

  const StrainEnergy& energy_;
  const double lambda_;
  std::function<Precondition(const Function& delta)> make_;
  std::function<void(Function&)> clear_;
  Workers& workers_;

  Function delta_, gradient_, at_corners_;
  StrainEnergy::Value value_;
  Precondition precondition_;  // none: it is made before the next step
  bool was_short_ = false;     // the last step, and lowered the energy by little
  std::deque<Step> steps_;
};

/// The part 2 v of a function is its u at vertex v, the part 2 v + 1 its v there: unknown `number`, or less that where
/// the sign is -1. So the vertices along a line of the lattice move as one across it.
struct Unknowns {
  std::vector<int> number;        ///< 2 #V; -1: the part is 0
  std::vector<signed char> sign;  ///< 2 #V
  int count = 0;

  /// Adds a symmetric matrix's entries at (p, q) and (q, p), parts of functions, to the lower triangle of that of the
  /// unknowns.
  void add(int p, int q, double value, std::vector<Eigen::Triplet<double>>& entries) const;
  /// Adds weight |turn y_b - y_a|^2 for vertices a and b.
  void add_difference(int a, int b, double weight, Complex turn, std::vector<Eigen::Triplet<double>>& entries) const;

  /// Each part of a function of the unknowns. @param x #unknowns
  Function spread(const Eigen::VectorXd& x) const;
  /// The transpose of that: the sums over the parts of each unknown.
  Eigen::VectorXd gathered(const Function& function) const;
  /// Whether other parts are the same unknown. @return 2 #V
  std::vector<char> shared() const;
};

/// What evening does not change, besides the jumps of the map.
struct Kept {
  std::vector<int> poles;  ///< vertices at which the map is infinite
  std::vector<int> u, v;   ///< ascending vertices at which u, or v, keeps its value, as on a straight boundary
  CornerTurns turns;       ///< by which the function turns at corners, as the jumps of the map do
  Unknowns unknowns;       ///< of a function that turns; parts that are none are in u or v as well
};

// The preconditioner of functions that turn from corner to corner: u and v are unknowns of one system.

/// An approximate inverse of the second derivatives of the energy.
class TurnedSolver {
 public:
  /// @param is_diagonal whether it is that of the diagonal alone, which is light and sees no further than an edge
  TurnedSolver(const mesh::Surface& surface, const Kept& kept, bool is_diagonal)
      : surface_(surface), kept_(kept), is_diagonal_(is_diagonal) {}

  /// @throws SolverError
  void make(const Array<double>& edge_weights);
  Function precondition(const Function& gradient);

 private:
  const mesh::Surface& surface_;
  const Kept& kept_;
  const bool is_diagonal_;
  Eigen::VectorXd diagonal_;
  solver::SparseCholesky factor_;
};

}  // namespace holomorph::uv
