// What evening keeps, and functions on vertices that turn from corner to corner, some of whose parts are one unknown.
#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "evening/strain_energy.h"

namespace holomorph::evening {

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

}  // namespace holomorph::evening
