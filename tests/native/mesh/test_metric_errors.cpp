// Weights of single triangles against 256 bits: within their bounds, and near enough to them that a tenth is too
// little.
#include "mesh/metric_errors.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "mesh/intrinsic_surface.h"
#include "mesh/intrinsic_triangulation.h"

namespace holomorph::mesh {
namespace {

using Lengths = std::array<double, 3>;

constexpr double kNear = 0.1;  // part of a bound that some true error is to exceed

// The cotangent opposite the first side, (b^2 + c^2 - a^2) / 4 A.
mpf_class exact_cotangent(double a, double b, double c) {
  const mpf_class x(a, 256), y(b, 256), z(c, 256);
  const mpf_class area = (x + y + z) * (y + z - x) * (x + z - y) * (x + y - z);
  return mpf_class((y * y + z * z - x * x) / sqrt(area), 256);
}

// Two congruent triangles glued to a torus of one vertex, whose lengths are exact: the weight of each edge is its
// cotangent. Returns the largest error of a weight over its bound.
double largest_part(const Lengths& lengths) {
  Execution execution(1);
  const auto surface =
      make_intrinsic_surface(1, {{0, 0, 0}, {0, 0, 0}}, {lengths, lengths}, {{0, 1, 2}, {0, 1, 2}}, execution);
  auto triangulation = given_triangulation(surface, half_edges(surface, execution), execution.workers());
  for (FaceError& error : triangulation.metric_errors) error = {};
  const auto weights = cotangent_weights(triangulation, execution);
  const auto errors = energy_errors(triangulation.metric(), weights, execution.workers());
  double largest = 0;
  for (std::size_t e = 0; e < weights.size(); ++e) {
    Lengths sides = lengths;
    std::rotate(sides.begin(), std::find(sides.begin(), sides.end(), surface.edge_lengths[e]), sides.end());
    const mpf_class missed = exact_cotangent(sides[0], sides[1], sides[2]) - weights[e];
    largest = std::max(largest, mpf_class(abs(missed) / errors[e]).get_d());
  }
  return largest;
}

template <class Make>
double largest_of(int count, const Make& make) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(1, 2);
  double largest = 0;
  for (int k = 0; k < count; ++k) largest = std::max(largest, largest_part(make(random, uniform)));
  return largest;
}

TEST(MetricErrors, WeightsOfAnyTriangles) {
  const double part = largest_of(20000, [](auto& random, auto& uniform) {
    const double a = uniform(random), b = uniform(random);
    return Lengths{a, b, std::max(a, b) + 0.2 * uniform(random)};
  });
  EXPECT_LE(part, 1);
  EXPECT_GE(part, kNear);
}

TEST(MetricErrors, WeightsOfTrianglesThatAreNearlyThin) {
  const double part = largest_of(20000, [](auto& random, auto& uniform) {
    const double a = uniform(random), b = 0.02 * a * uniform(random);
    return Lengths{a, b, std::hypot(a, b)};
  });
  EXPECT_LE(part, 1);
  EXPECT_GE(part, kNear);
}

TEST(MetricErrors, WeightsOfThinRightTriangles) {
  for (const double width : {1e-3, 1e-5, 1e-7}) {
    const double part = largest_of(5000, [&](auto& random, auto& uniform) {
      const double a = uniform(random), b = width * uniform(random);
      return Lengths{a, b, std::hypot(a, b)};
    });
    EXPECT_LE(part, 1) << width;
    EXPECT_GE(part, kNear) << width;
  }
}

TEST(MetricErrors, WeightsOfNeedles) {
  for (const double width : {1e-9, 1e-11}) {
    const double part = largest_of(5000, [&](auto& random, auto& uniform) {
      const double a = uniform(random);
      return Lengths{a, width * uniform(random), a};
    });
    EXPECT_LE(part, 1) << width;
    EXPECT_GE(part, kNear) << width;
  }
}

}  // namespace
}  // namespace holomorph::mesh
