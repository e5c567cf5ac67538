#include "uv/direction.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/workers.h"

namespace holomorph::uv {
namespace {

constexpr double kSteep = 0.35;  // least sine of the angle between the normal of a triangle and the vertical

// The differences of a function along the two sides of a triangle from its first corner on.
using Differences = std::array<double, 2>;

}  // namespace

std::complex<double> uphill(const mesh::Surface& surface, const Eigen::Ref<const UvArray>& uv, int triangle,
                            const std::array<double, 3>& axis) {
  std::array<std::complex<double>, 3> z;
  for (int i = 0; i < 3; ++i)
    z[i] = {uv(surface.triangle_corners[triangle][i], 0), uv(surface.triangle_corners[triangle][i], 1)};
  std::complex<double> sum = 0;
  for (int i = 0; i < 3; ++i) {
    const auto& p = surface.polygons.vertices[surface.triangles[triangle][i]];
    const double height = p[0] * axis[0] + p[1] * axis[1] + p[2] * axis[2];
    const std::complex<double> across = z[(i + 2) % 3] - z[(i + 1) % 3];
    sum += std::complex<double>(-0.5 * across.imag() * height, 0.5 * across.real() * height);
  }
  return sum;
}

TriangleTurn triangle_turn(const std::array<std::array<double, 3>, 3>& points, const std::array<double, 3>& v, Up up) {
  std::array<Differences, 3> sides;
  for (int i = 0; i < 3; ++i) sides[i] = {points[1][i] - points[0][i], points[2][i] - points[0][i]};
  const auto metric = [&](int i, int j) {
    return sides[0][i] * sides[0][j] + sides[1][i] * sides[1][j] + sides[2][i] * sides[2][j];
  };
  const double a = metric(0, 0), b = metric(0, 1), c = metric(1, 1);
  const double squared = std::max(a * c - b * b, 0.0);  // of twice the area
  // The product of the gradients of two functions, times `squared`.
  const auto product = [&](const Differences& p, const Differences& q) {
    return p[0] * q[0] * c - (p[0] * q[1] + p[1] * q[0]) * b + p[1] * q[1] * a;
  };
  const Differences rises{v[1] - v[0], v[2] - v[0]}, heights = sides[static_cast<int>(up)];
  const double steepness = product(heights, heights), length = product(rises, rises);
  const double cosine = product(rises, heights) / std::sqrt(steepness * length);
  const double angle = std::isnan(cosine) ? 0.0 : std::acos(std::clamp(cosine, -1.0, 1.0));
  return {angle * (180 / std::numbers::pi), std::sqrt(squared) / 2,
          steepness > kSteep * kSteep * squared && length > 0};
}

Direction direction(const mesh::Surface& surface, const Eigen::Ref<const UvArray>& uv, Up up, int turns,
                    Workers& workers) {
  const std::size_t count = surface.triangles.size();
  Direction result{Array<double>(count), Array<double>(count)};
  result.area = sum_over_rows(workers, static_cast<int>(count), 0.0, [&](int t, double& sum) {
    std::array<std::array<double, 3>, 3> points;
    std::array<double, 3> v;
    for (int i = 0; i < 3; ++i) {
      points[i] = surface.polygons.vertices[surface.triangles[t][i]];
      v[i] = uv(surface.triangle_corners[t][i], 1);
    }
    const TriangleTurn found = triangle_turn(points, v, up);
    result.angle[t] = found.angle;
    result.steep[t] = found.is_steep ? found.area : 0.0;
    sum += found.area;
  });
  return under(std::move(result), turns);
}

Direction under(Direction direction, int turns) {
  const double period = 360.0 / turns;
  direction.turns = turns;
  if (turns == 1) return direction;
  for (double& angle : direction.angle) angle = std::abs(angle - period * std::nearbyint(angle / period));
  return direction;
}

Direction joined(const std::vector<const Direction*>& parts) {
  Direction result{{}, {}, 0, parts.front()->turns};
  for (const Direction* each : parts) {
    result.angle.insert(result.angle.end(), each->angle.begin(), each->angle.end());
    result.steep.insert(result.steep.end(), each->steep.begin(), each->steep.end());
    result.area += each->area;
  }
  return result;
}

}  // namespace holomorph::uv
