#include "solver/solver_choice.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "base/errors.h"
#include "solver/direct/direct_solver.h"
#include "solver/direct/sparse_cholesky.h"
#include "solver/multigrid/multigrid_solver.h"

namespace holomorph::solver {
namespace {

// Below this number of unknowns the direct solver takes less than a tenth of a second, and leaves smaller residuals.
constexpr double kSmall = 25'000;
// A factorisation is made once, and each further right-hand side is cheaper with it. At kLarge unknowns the direct
// solver is taken from kMany right-hand sides on, elsewhere in proportion to the cube root of the size.
constexpr double kMany = 64, kLarge = 500'000;
// Memory of a factor is about kFactorBytes n log2 n bytes; no more than kMostBytes is asked for.
constexpr double kFactorBytes = 60, kMostBytes = 4e9;

std::string system_of(Eigen::Index unknowns, Eigen::Index right_hand_sides) {
  return std::to_string(unknowns) + " unknowns and " + std::to_string(right_hand_sides) + " right-hand sides";
}

}  // namespace

Choice choose_method(const std::string& name, Eigen::Index unknowns, Eigen::Index right_hand_sides) {
  if (name == "direct") return {Method::direct, "asked for"};
  if (name == "multigrid") return {Method::multigrid, "asked for"};
  if (name == "paper") {
    throw TopologyError(
        "the paper's solver is for the forms of handles and boundaries; one of auto, direct, multigrid is needed here");
  }
  if (name != "auto") throw Error("there is no solver '" + name + "'; one of auto, direct, multigrid is needed");
  const auto n = static_cast<double>(unknowns);
  const std::string system = system_of(unknowns, right_hand_sides);
  if (n < kSmall) return {Method::direct, "few unknowns: " + system};
  if (!SparseCholesky::supernodal()) return {Method::multigrid, "built without CHOLMOD: " + system};
  const double many = kMany * std::cbrt(n / kLarge);
  if (static_cast<double>(right_hand_sides) < many) return {Method::multigrid, "few right-hand sides: " + system};
  if (factor_bytes(n) > kMostBytes) return {Method::multigrid, "the factor would take too much memory: " + system};
  return {Method::direct, "many right-hand sides: " + system};
}

double factor_bytes(double unknowns) { return kFactorBytes * unknowns * std::log2(std::max(unknowns, 2.0)); }

std::unique_ptr<LaplaceSolver> make_solver(Method method, Laplacian&& L, std::vector<int> fixed, Execution& execution,
                                           double goal) {
  std::sort(fixed.begin(), fixed.end());
  fixed.erase(std::unique(fixed.begin(), fixed.end()), fixed.end());
  assert(fixed.empty() || (fixed.front() >= 0 && fixed.back() < L.size()));
  return method == Method::direct ? make_direct_solver(std::move(L), std::move(fixed), execution)
                                  : make_multigrid_solver(std::move(L), std::move(fixed), goal, execution);
}

}  // namespace holomorph::solver
