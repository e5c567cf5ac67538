#include "uv/appearance.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace holomorph::uv {
namespace {

// For the whole map, and for that it does overlap, since it cannot be painted or baked.
constexpr double kOverlapping = 20, kOverlaps = 0.2;

}  // namespace

double cost_of_squares(const Squares& squares) {
  const double ratio = squares.density_ratio;
  if (!(ratio >= 1) || std::isinf(ratio)) return std::numeric_limits<double>::infinity();
  return std::log(ratio) + kShear * (squares.mean_angle - 1) + kFlipped * squares.flipped_part +
         cost_of_overlaps(squares.overlapping_part);
}

double cost_of_squares(const Quality& quality) {
  return cost_of_squares(
      {quality.density_ratio, quality.mean_angle, quality.flipped_part, quality.overlapping_part.value_or(0)});
}

double cost_of_overlaps(double overlapping_part) {
  return kOverlapping * overlapping_part + (overlapping_part > kRounding ? kOverlaps : 0);
}

double cost_of_direction(const Direction& direction) {
  if (!(direction.area > 0)) return 0;
  double sum = 0;
  for (std::size_t t = 0; t < direction.angle.size(); ++t) {
    const double angle = direction.angle[t], least = angle > 90 ? kOnItsHead : 0;
    sum += direction.steep[t] * (least + (kSideways - least) * std::sin(angle * (std::numbers::pi / 180)));
  }
  return sum / direction.area;
}

double cost(const Quality& quality, const Marks& marks) {
  const double direction = quality.direction ? cost_of_direction(*quality.direction) : 0;
  return cost_of_squares(quality) + direction + cost_of_marks(marks);
}

double cost_of_marks(const Marks& marks) {
  return kSeam * marks.soft_seams + kHardSeam * marks.hard_seams + kPole * marks.poles + kCone * marks.cones;
}

}  // namespace holomorph::uv
