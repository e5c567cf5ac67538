// Weights of single triangles against 256 bits: within their bounds, and near enough to them that a tenth is too
// little.
#include "mesh/metric_errors.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "mesh/intrinsic_surface.h"

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

// ---- thin triangles whose cotangents cancel each other --------------------------------------------------------------

// Triangles by their cotangents opposite the first side, which Kahan's order leaves all digits but the last.
using Sided = std::pair<long double, Lengths>;

long double near_cotangent(long double a, long double b, long double c) {
  std::array<long double, 3> x{a, b, c};
  std::sort(x.begin(), x.end());
  const auto [least, middle, most] = x;
  const long double area =
      (most + (middle + least)) * (least - (most - middle)) * (least + (most - middle)) * (most + (middle - least));
  return ((b - a) * (b + a) + c * c) / std::sqrt(area);
}

// Triangles whose last two lengths are others than these by some rounding.
std::vector<Sided> triangles_near(const Lengths& lengths) {
  constexpr int kUnits = 32;
  std::vector<Sided> found;
  for (int i = -kUnits; i < kUnits; ++i) {
    for (int j = -kUnits; j < kUnits; ++j) {
      const double b = lengths[1] * (1 + i * 0x1p-52), c = lengths[2] * (1 + j * 0x1p-52);
      found.push_back({near_cotangent(lengths[0], b, c), {lengths[0], b, c}});
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

// Pairs of thin triangles with a common first side, whose cotangents opposite of it cancel to a unit of rounding. One
// is obtuse there, with its height above `part` of the side; the other one is isosceles, and has what is left of 180
// degrees there.
std::vector<std::array<Lengths, 2>> cancelling(double side, double angle, double part) {
  const double height = angle * part * (1 - part);
  const auto obtuse = triangles_near({side, side * std::hypot(part, height), side * std::hypot(1 - part, height)});
  const auto others =
      triangles_near({side, side, 2 * side * std::cos(std::atan2(height, part) + std::atan2(height, 1 - part))});
  std::vector<std::array<Lengths, 2>> found;
  for (const auto& [cotangent, lengths] : obtuse) {
    const auto other = std::lower_bound(others.begin(), others.end(), Sided(-cotangent, {}));
    if (other != others.end() && cotangent + other->first < 0x1p-54L * other->first)
      found.push_back({lengths, other->second});
  }
  return found;
}

// The error of the weight of the common side over its bound, where energies of both triangles grow by `growth`.
double part_of_quad(const std::array<Lengths, 2>& sides, double growth) {
  Execution execution(1);
  const auto& [lower, upper] = sides;
  const auto surface =
      make_intrinsic_surface(4, {{0, 1, 2}, {3, 2, 1}}, {lower, upper}, {{0, 1, 2}, {0, 3, 4}}, execution);
  auto triangulation = given_triangulation(surface, half_edges(surface, execution), execution.workers());
  for (FaceError& error : triangulation.metric_errors) error = {growth, growth};
  const auto weights = cotangent_weights(triangulation, execution);
  const auto errors = energy_errors(triangulation.metric(), weights, execution.workers());
  const mpf_class exact =
      (exact_cotangent(lower[0], lower[1], lower[2]) + exact_cotangent(upper[0], upper[1], upper[2])) / 2;
  const mpf_class missed = exact - weights[0];
  return mpf_class((missed + growth * exact) / errors[0]).get_d();
}

double largest_of_quads(int count, double growth) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0.1, 0.9);
  double largest = 0;
  for (int k = 0; k < count; ++k) {
    const double angle = 0.02 * (1 - 0.4 * uniform(random));
    for (const auto& sides : cancelling(1 + uniform(random), angle, uniform(random)))
      largest = std::max(largest, part_of_quad(sides, growth));
  }
  return largest;
}

TEST(MetricErrors, WeightsInWhichThinTrianglesCancel) {
  const double part = largest_of_quads(800, 0);
  EXPECT_LE(part, 1);
  EXPECT_GE(part, kNear / 3);  // a bound for each of 39 operations
}

TEST(MetricErrors, GrowthInWhichThinTrianglesCancel) { EXPECT_LE(largest_of_quads(100, 1e-3), 1); }

}  // namespace
}  // namespace holomorph::mesh
