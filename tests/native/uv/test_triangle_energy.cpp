// The energy of one triangle: its derivatives by differences, and what it is where shear or size alone is there.
#include "uv/strain_energy.h"

#include <gtest/gtest.h>

#include <cmath>

namespace holomorph::uv {
namespace {

constexpr double kLogSize = 0.3, kStep = 1e-5;
constexpr double kLambdas[] = {0, 0.1, 0.37, 0.7};

double value(double a, double b, double lambda) { return triangle_energy(a * a, b * b, lambda, kLogSize).value; }

TEST(TriangleEnergy, DerivativesAreThoseOfTheValue) {
  for (const double lambda : kLambdas) {
    for (const double a : {1e-3, 0.2, 1.0, 1.16, 7.0, 3e2}) {
      for (const double ratio : {0.01, 0.3, 0.69, 0.71, 0.99, 1.5}) {  // up to 0.7 the logarithm's, flipped above 1
        const double b = a * ratio, h = kStep * a;
        const TriangleEnergy found = triangle_energy(a * a, b * b, lambda, kLogSize);
        const double by_a = (value(a + h, b, lambda) - value(a - h, b, lambda)) / (2 * h);
        const double by_b = (value(a, b + h, lambda) - value(a, b - h, lambda)) / (2 * h);
        const double scale = (1 + found.value) / a;
        EXPECT_NEAR(found.by_a * a, by_a, 1e-6 * scale) << lambda << ' ' << a << ' ' << ratio;
        EXPECT_NEAR(found.by_b * b, by_b, 1e-6 * scale) << lambda << ' ' << a << ' ' << ratio;
      }
    }
  }
}

TEST(TriangleEnergy, ConformalAndOfTheMeanSizeIsLeast) {
  for (const double lambda : kLambdas) EXPECT_NEAR(value(std::exp(kLogSize / 2), 0, lambda), 0, 1e-15);
}

TEST(TriangleEnergy, ShearAloneIsItsLogarithmSquared) {
  const double ratio = 0.4, shear = std::log((1 + ratio) / (1 - ratio));
  const double a = std::exp(kLogSize / 2) / std::sqrt(1 - ratio * ratio);  // of the mean size
  for (const double lambda : kLambdas) EXPECT_NEAR(value(a, ratio * a, lambda), (1 - lambda) * shear * shear, 1e-13);
}

TEST(TriangleEnergy, ExtremesOfSizeCountMoreThanTheirSquare) {
  for (const double size : {-3.0, -1.0, 1.0, 3.0}) {
    const double a = std::exp((kLogSize + size) / 2), square = size * size;
    EXPECT_NEAR(value(a, 0, 0.7), 0.7 * square, 1e-12) << "at evenness 1 the square alone";
    EXPECT_NEAR(value(a, 0, 0.2), 0.2 * square * (1 + 0.6 * square / (1 + square / 2)), 1e-12);
  }
}

TEST(TriangleEnergy, StiffnessIsOneWhereNothingIsStrained) {
  for (const double lambda : kLambdas) EXPECT_NEAR(stiffness(0, 0, lambda), 1, 1e-14);
}

}  // namespace
}  // namespace holomorph::uv
