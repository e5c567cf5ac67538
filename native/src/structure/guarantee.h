// What is promised of every result when it leaves, checked in one place.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "structure/structure.h"

namespace holomorph::structure {

/// Bounds cross by no more than this, relative: the rounding where no triangle is thin.
inline constexpr double kCertain = 1e-11;
/// The largest part of an energy that rounding may change: beyond, not even the first digit is certain.
inline constexpr double kMostUncertain = 0.5;

/// Gram matrices that are certainly not below those of the surface: G + E, E by how much rounding may change G.
/// @param errors for each of `gram`, or none where it is negligible
/// @throws SolverError where E is more than kMostUncertain of G
std::vector<Eigen::MatrixXd> certain_gram(const std::vector<Eigen::MatrixXd>& gram,
                                          const std::vector<Eigen::MatrixXd>& errors);

/// @param allowed part of the upper bound by which they may cross
/// @throws SolverError where bounds are not finite or cross: lower <= upper as quadratic forms
void require_ordered(const Eigen::MatrixXd& lower, const Eigen::MatrixXd& upper, double allowed = kCertain);

/// That invariants are finite, that the linear systems were solved to what is promised, and that bounds do not cross.
/// @throws SolverError
void require_guaranteed(const Structure& structure);

}  // namespace holomorph::structure
