#include "uv/triangle_energy.h"

#include <algorithm>
#include <cmath>

namespace holomorph::uv {
namespace {

// Up to this ratio of |b| to |a|, which is s1 / s2 up to 6, the energy is that of the logarithmic strain. Beyond, where
// that goes to infinity, it continues as a parabola. So a triangle may flip on the way, and is driven back.
constexpr double kStrained = 0.7;

// Extremes of size count more than by their square. At evenness 1 they do not: there this would make the bulk less
// even. Where the square exceeds kReached, the fourth power turns into a square again, since the sizes next to a pole
// cannot be evened.
constexpr double kExtremes = 1.2, kNoExtremes = 0.7, kReached = 2;

struct Derivative {
  double value, slope;
};

// Returns shear^2, and its derivative divided by `ratio`, for the ratio r = |b| / |a|: shear = ln((1 + r) / (1 - r)) =
// 2 atanh(r).
Derivative squared_shear(double ratio) {
  const auto exact = [](double r) -> Derivative {
    // The limit for small r, where the quotient below would be 0 / 0.
    if (r < 1e-6) return {4 * r * r, 8};
    const double shear = 2 * std::atanh(r);
    return {shear * shear, 4 * shear / (r * (1 - r * r))};
  };
  if (ratio <= kStrained) return exact(ratio);
  // The second derivative at kStrained: there value, slope and curvature are continuous.
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
  // ln(s1 s2), since s1 s2 = |a|^2 (1 - r^2). Beyond kStrained r counts as kStrained: the area of a flipped triangle
  // has no logarithm.
  const double size = std::log(square_a * (1 - strained * strained)) - log_size;
  const double square = size * size, reach = 1 / (1 + square / kReached);
  const double extreme = weight_of_extremes(lambda) * square * reach;
  // 2 dE / d(size), as size grows with 2 ln |a|.
  const double by_size = 4 * lambda * size * (1 + extreme * (1 + reach));
  const auto [shear, slope] = squared_shear(ratio);
  double by_ratio = (1 - lambda) * slope;  // dE / dr over r, at fixed |a|
  if (ratio < kStrained) by_ratio -= by_size / (1 - ratio * ratio);
  // With r = |b| / |a|, dr / d|a| = -r / |a| and dr / d|b| = 1 / |a|.
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

}  // namespace holomorph::uv
