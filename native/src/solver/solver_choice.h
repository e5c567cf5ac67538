// Which solver serves a system, and its making.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "solver/laplace_solver.h"

namespace holomorph::solver {

enum class Method { direct, multigrid };

struct Choice {
  Method method = Method::direct;
  std::string reason;  ///< one phrase, e.g. "asked for"
};

/// @param name "auto", "direct" or "multigrid"; "auto" takes the faster one by size alone, so that the bits do not
/// depend on the machine
/// @throws Error for another name
Choice choose_method(const std::string& name, Eigen::Index unknowns, Eigen::Index right_hand_sides);

/// Estimates the memory of the direct solver's factor, in bytes.
double factor_bytes(double unknowns);

/// Prepares the factorisation (direct/direct_solver.h) or the hierarchy (multigrid/multigrid_solver.h).
/// @param fixed vertices in any order. @pre they are in range
/// @param goal of multigrid; the direct solver has none
/// @throws SolverError if the factorisation fails; Cancelled
std::unique_ptr<LaplaceSolver> make_solver(Method method, Laplacian&& L, std::vector<int> fixed, Execution& execution,
                                           double goal = kGoal);

}  // namespace holomorph::solver
