#include <gtest/gtest.h>

#include <limits>

#include "base/errors.h"
#include "structure/structure.h"

namespace holomorph::structure {
namespace {

using Eigen::MatrixXd;

const MatrixXd kGram{{2.0, 1.0}, {1.0, 3.0}};

TEST(Guarantee, CertainGramMatricesHaveTheirErrorsAdded) {
  EXPECT_EQ(certain_gram({kGram}, {}).certain[0], kGram);
  EXPECT_EQ(certain_gram({kGram}, {1e-9 * kGram}).certain[0], kGram + 1e-9 * kGram);
}

TEST(Guarantee, EnergiesWithoutACertainDigitAreRefused) {
  EXPECT_NO_THROW(certain_gram({kGram}, {0.9 * kMostUncertain * kGram}));
  EXPECT_THROW(certain_gram({kGram}, {1.1 * kMostUncertain * kGram}), SolverError);
}

TEST(Guarantee, BoundsMayTouchAndNotCross) {
  EXPECT_NO_THROW(require_ordered(kGram, kGram));
  EXPECT_NO_THROW(require_ordered(kGram, (1 - 0.1 * kCertain) * kGram));
  EXPECT_THROW(require_ordered(kGram, (1 - 10 * kCertain) * kGram), SolverError);
  // Larger in one direction, smaller in another.
  EXPECT_THROW(require_ordered(MatrixXd{{1.0, 0.0}, {0.0, 1.0}}, MatrixXd{{2.0, 0.0}, {0.0, 0.9}}), SolverError);
}

TEST(Guarantee, BoundsAreFinite) {
  const MatrixXd none = MatrixXd::Constant(1, 1, std::numeric_limits<double>::quiet_NaN());
  EXPECT_THROW(require_ordered(none, MatrixXd::Ones(1, 1)), SolverError);
  EXPECT_THROW(require_ordered(MatrixXd::Ones(1, 1), none), SolverError);
}

TEST(Guarantee, ASystemThatWasNotSolvedIsRefused) {
  Structure structure;
  structure.record.mollification = 1;
  EXPECT_NO_THROW(require_guaranteed(structure));
  structure.record.solver.residual = 1e-3;
  EXPECT_THROW(require_guaranteed(structure), SolverError);
  structure.record.solver.residual = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(require_guaranteed(structure), SolverError);
}

}  // namespace
}  // namespace holomorph::structure
