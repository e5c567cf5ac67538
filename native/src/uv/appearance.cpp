#include "uv/appearance.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/constants.h"

namespace holomorph::uv {
namespace {

constexpr double kUpright = 15;  // degrees from up, at most

// The inner products of two sides of a triangle, and its area.
struct Metric {
  double a, b, c, area;
};

template <std::size_t N>
Metric metric(const std::array<std::array<double, N>, 3>& at) {
  double a = 0, b = 0, c = 0;
  for (std::size_t i = 0; i < N; ++i) {
    const double x = at[1][i] - at[0][i], y = at[2][i] - at[0][i];
    a += x * x, b += x * y, c += y * y;
  }
  return {a, b, c, 0.5 * std::sqrt(std::max(a * c - b * b, 0.0))};
}

// A triangle that is drawn, in space and in the plane.
struct Drawn {
  std::array<std::array<double, 3>, 3> points;
  std::array<std::array<double, 2>, 3> at;
};

// Calls visit(polygon, triangle) for all of them.
template <class Visit>
void for_drawn(const mesh::Polygons& polygons, const Eigen::Ref<const UvArray>& uv, const Visit& visit) {
  for (std::size_t f = 0; f + 1 < polygons.face_offsets.size(); ++f) {
    const int first = polygons.face_offsets[f];
    for (int c = first + 1; c + 1 < polygons.face_offsets[f + 1]; ++c) {
      Drawn triangle;
      const std::array<int, 3> corners{first, c, c + 1};
      for (int i = 0; i < 3; ++i) {
        triangle.points[i] = polygons.vertices[polygons.corner_vertices[corners[i]]];
        triangle.at[i] = {uv(corners[i], 0), uv(corners[i], 1)};
      }
      visit(f, triangle);
    }
  }
}

// s1 / s2 of a triangle with an area.
double shear(const Metric& g, const Metric& h) {
  const double half = (g.c * h.a - 2 * g.b * h.b + g.a * h.c) / (8 * g.area * h.area);  // (s1 / s2 + s2 / s1) / 2
  const double angle = half + std::sqrt(std::max(half * half - 1, 0.0));
  return angle >= 1 ? std::min(angle, kCollapsedAngle) : std::isnan(angle) ? kCollapsedAngle : 1;
}

Densities densities(const Array<double>& density, const Array<double>& area, Workers& workers) {
  const Distribution found(density, area, workers);
  return {found.quantile(kLow), found.quantile(0.5), found.quantile(kHigh)};
}

// For the whole map, and for that it does overlap, since it cannot be painted or baked.
constexpr double kOverlapping = 20, kOverlaps = 0.2;

}  // namespace

Distortion distortion(const mesh::Polygons& polygons, const Eigen::Ref<const UvArray>& uv, Up up, Workers& workers) {
  const std::size_t count = polygons.face_offsets.size() - 1;
  Distortion result{Array<double>(count, 0), Array<double>(count, 0), Array<double>(count, 0)};
  Array<double> area(count, 0), uv_area(count, 0), steep(count, 0);
  double all_steep = 0, upright = 0;
  for_drawn(polygons, uv, [&](std::size_t f, const Drawn& triangle) {
    const Metric g = metric(triangle.points), h = metric(triangle.at);
    area[f] += g.area;
    uv_area[f] += h.area;
    result.angle[f] += g.area > 0 ? g.area * shear(g, h) : 0;
    const auto& at = triangle.at;
    const TriangleTurn turn = triangle_turn(triangle.points, {at[0][1], at[1][1], at[2][1]}, up);
    if (!turn.is_steep) return;
    steep[f] += turn.area;
    result.direction[f] += turn.area * turn.angle;
    all_steep += turn.area;
    if (turn.angle < kUpright) upright += turn.area;
  });
  double all = 0, sum = 0;
  for (std::size_t f = 0; f < count; ++f) {
    result.density[f] = area[f] > 0 ? uv_area[f] / area[f] : 0;
    result.angle[f] = area[f] > 0 ? result.angle[f] / area[f] : 1;
    result.direction[f] = steep[f] > 0 ? result.direction[f] / steep[f] : 0;
    all += area[f];
    sum += area[f] * std::min(result.angle[f], kMostAngle);
  }
  const auto [low, median, high] = densities(result.density, area, workers);
  for (std::size_t f = 0; f < count; ++f) {
    const double octaves = area[f] > 0 ? std::log2(result.density[f] / median) : 0;
    result.density[f] = std::isnan(octaves) ? 0 : std::clamp(octaves, -kMostOctaves, kMostOctaves);
  }
  result.mean_angle = all > 0 ? sum / all : 1;
  result.size_range = low > 0 ? std::sqrt(high / low) : kInfinity;
  result.upright_part = all_steep > 0 ? upright / all_steep : 1;
  return result;
}

Densities drawn_densities(const mesh::Polygons& polygons, const Eigen::Ref<const UvArray>& uv, Workers& workers) {
  Array<double> density, area;
  for_drawn(polygons, uv, [&](std::size_t, const Drawn& triangle) {
    const double own = metric(triangle.points).area;
    if (!(own > 0)) return;
    area.push_back(own);
    density.push_back(metric(triangle.at).area / own);
  });
  return densities(density, area, workers);
}

double cost_of_squares(const Squares& squares) {
  const double ratio = squares.density_ratio;
  if (!(ratio >= 1) || std::isinf(ratio)) return kInfinity;
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
