// K right-hand sides at once: conjugate gradients in single precision inside a correction in double precision.
#pragma once

#include <array>
#include <functional>

#include "solver/laplace_solver.h"
#include "solver/multigrid/cycle.h"

namespace holomorph::solver {

/// With the Dirichlet condition nothing is asked of x at a fixed vertex. With the natural one the mean is subtracted:
/// it is rounding, and no x solves for it. To be captured by value: loops over it write doubles, and the compiler would
/// otherwise reload the pointers and sums after each write.
template <int K>
struct RightHandSides {
  std::array<const double*, K> columns;
  Sums<K> natural;     ///< 1 for those with the natural condition, 0 for the others
  const float* omega;  ///< `omega` of Operator
  Sums<K> mean = Sums<K>::Zero();

  /// Entry i of each.
  EIGEN_STRONG_INLINE Sums<K> operator()(int i) const {
    Sums<K> all;
    for (int d = 0; d < K; ++d) all[d] = columns[d][i];
    return masked(i, all - mean);
  }

  /// A residual r at vertex i, 0 where nothing is asked of x.
  EIGEN_STRONG_INLINE Sums<K> masked(int i, const Sums<K>& r) const {
    if (omega[i] >= 0) return r;
    return r * natural;
  }
};

/// Corrects X by preconditioned conjugate gradients until |B - L X| <= 1e-10 |B| for every right-hand side. The
/// residual B - L X is computed in double precision from differences of X. Single precision is asked for a factor of
/// 1e-4 at a time, so that its rounding does not matter; usually three corrections do.
///
/// A p is not computed: it follows from A z like p from z, and p.A p from z.A z (Chronopoulos and Gear 1989,
/// doi:10.1016/0377-0427(89)90045-9). So all sums of an iteration are known at its end.
template <int K>
class BlockSolve {
 public:
  /// Called at every iteration with the largest relative residual; may throw.
  using Report = std::function<void(double residual)>;

  /// @param hierarchy of L; both outlive this
  /// @param goal relative residual to go on to while that helps
  BlockSolve(const Laplacian& L, const Hierarchy& hierarchy, double goal, Workers& workers);

  /// Solves for the columns first .. first + width - 1 of B, width <= K, and writes the same columns of X.
  /// @param conditions of all columns
  /// @throws SolverError after 300 iterations or two corrections without success; what `report` throws
  void solve(const Eigen::MatrixXd& B, const std::vector<Condition>& conditions, Eigen::Index first, int width,
             Solution& X, const Report& report);

  /// Writes M B for the same columns, M one V-cycle.
  void run_cycle(const Eigen::MatrixXd& B, const std::vector<Condition>& conditions, Eigen::Index first, int width,
                 Solution& X);

  int iterations() const { return iterations_; }
  /// Largest |B - L X| / |B| of the last solve, as computed in double precision.
  double residual() const { return reached_; }

 private:
  RightHandSides<K> right_hand_sides(const Eigen::MatrixXd& B, const std::vector<Condition>& conditions,
                                     Eigen::Index first, int width);
  void begin(RightHandSides<K>& b);
  void correct_until_solved(const RightHandSides<K>& b, const Report& report);
  void update_residual(const RightHandSides<K>& b);
  void conjugate_gradients(const Report& report);
  Sums<K> step(const Block<K>& alpha, const Block<K>& beta);
  void precondition(Sums<K>& rz, Sums<K>& zAz);

  const Laplacian& L_;
  const Operator& A_;
  const int n_;
  const double goal_;
  Workers& workers_;
  Cycle<K> cycle_;
  Array<Sums<K>> x_;         // the solution, #V
  Blocks<K> p_, q_;          // p, A p, #V
  Block<K> natural_;         // memory of jacobi_step()
  Sums<K> norm_b_, norm_r_;  // |B|, |B - L X|
  Sums<K> scale_;            // by which the residual is divided for single precision
  int iterations_ = 0;
  double reached_ = 0;
};

extern template class BlockSolve<2>;
extern template class BlockSolve<4>;
extern template class BlockSolve<8>;

}  // namespace holomorph::solver
