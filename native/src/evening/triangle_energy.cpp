#include "evening/triangle_energy.h"

#include <algorithm>
#include <cmath>

namespace holomorph::evening {
namespace {

// Up to this ratio of |b| to |a| the energy is that of the logarithmic strain, s1 / s2 up to 6; beyond, where it would
// become infinite, it goes on as a parabola. So a triangle may flip on the way, and is driven back.
constexpr double kStrained = 0.7;

// Extremes of size count more than by their square. At evenness 1 they do not: there they would make the bulk less
// even. Beyond the square kReached their fourth power turns into a square again, for sizes next to a pole cannot be
// reached.
constexpr double kExtremes = 1.2, kNoExtremes = 0.7, kReached = 2;

struct Derivative {
  double value, slope;
};

// shear^2 and its derivative over `ratio`, for the ratio |b| / |a|.
Derivative squared_shear(double ratio) {
  const auto exact = [](double r) -> Derivative {
    if (r < 1e-6) return {4 * r * r, 8};
    const double shear = 2 * std::atanh(r);
    return {shear * shear, 4 * shear / (r * (1 - r * r))};
  };
  if (ratio <= kStrained) return exact(ratio);
  static const double curvature = [] {
    const double open = 1 - kStrained * kStrained;
    return 8 * (1 + 2 * kStrained * std::atanh(kStrained)) / (open * open);
  }();
  const auto [value, slope] = exact(kStrained);
  const double beyond = ratio - kStrained;
  return {value + (slope * kStrained + curvature * beyond / 2) * beyond,
          (slope * kStrained + curvature * beyond) / ratio};
}

// c(lambda)
double weight_of_extremes(double lambda) { return kExtremes * std::max(0.0, kNoExtremes - lambda); }

}  // namespace

TriangleEnergy triangle_energy(double square_a, double square_b, double lambda, double log_size) {
  const double ratio = std::sqrt(square_b / square_a), strained = std::min(ratio, kStrained);
  const double size = std::log(square_a * (1 - strained * strained)) - log_size;
  const double square = size * size, reach = 1 / (1 + square / kReached);
  const double extreme = weight_of_extremes(lambda) * square * reach;
  const double by_size = 4 * lambda * size * (1 + extreme * (1 + reach));
  const auto [shear, slope] = squared_shear(ratio);
  double by_ratio = (1 - lambda) * slope;  // over the ratio
  if (ratio < kStrained) by_ratio -= by_size / (1 - ratio * ratio);
  return {(1 - lambda) * shear + lambda * square * (1 + extreme), (by_size - ratio * ratio * by_ratio) / square_a,
          by_ratio / square_a};
}

double stiffness(double ratio, double size, double lambda) {
  const double strained = std::min(ratio, kStrained), open = 1 - strained * strained;
  const double curvature = 8 * (1 + 2 * strained * std::atanh(strained)) / (open * open);
  const double slope = squared_shear(ratio).slope;
  const double shear = (curvature * (1 + ratio * ratio) + 2 * slope * ratio * ratio) / 8;
  const double square = size * size, reach = 1 / (1 + square / kReached);
  const double extreme = weight_of_extremes(lambda) * square * reach * (1 + 5 * reach);
  return (1 - lambda) * shear + lambda * (1 + extreme + std::max(0.0, -size / 2));
}

}  // namespace holomorph::evening
