// Energies of forms with all that rounding may change, and bounds made of them.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "base/execution.h"
#include "forms/closed_forms.h"
#include "mesh/discretisation.h"

namespace holomorph::structure {

/// The relative amount by which bounds may cross: rounding, where no triangle is thin.
inline constexpr double kCertain = 1e-11;
/// The largest relative change of an energy by rounding that is accepted: beyond it, not even the first digit is
/// certain.
inline constexpr double kMostUncertain = 0.5;

/// Gram matrices of forms, one for each family, and matrices that are certainly not below those of the surface.
struct CertainGram {
  std::vector<Eigen::MatrixXd> gram, certain;
};

/// Adds to each Gram matrix the bound of its rounding: G + E.
/// @param errors E for each of `gram`, or none where they are negligible
/// @throws SolverError where E is more than kMostUncertain of G
CertainGram certain_gram(std::vector<Eigen::MatrixXd> gram, const std::vector<Eigen::MatrixXd>& errors);

/// Measures the energies of forms on a discretisation. @param families numbers of forms
/// @throws SolverError where rounding leaves no digit
CertainGram certain_energies(const mesh::Discretisation& discretisation, const forms::ClosedForms& forms,
                             const std::vector<int>& families, Execution& execution);

/// Checks that lower <= upper as quadratic forms. @param allowed amount by which they may cross, relative to the upper
/// bound
/// @throws SolverError where bounds are not finite or cross
void require_ordered(const Eigen::MatrixXd& lower, const Eigen::MatrixXd& upper, double allowed = kCertain);

/// Reports a failure that triangles too thin for double precision cause. @throws SolverError always
[[noreturn]] void refuse(const std::string& what, double size, double allowed);

}  // namespace holomorph::structure
