#include "uv/quality.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numeric>

#include "base/chunks.h"
#include "mesh/triangle_geometry.h"
#include "uv/quantiles.h"

namespace holomorph::uv {
namespace {

using Complex = std::complex<double>;

// Largest s2 / s1 of a collapsed triangle: rounding.
constexpr double kCollapsed = 1e-12;

// The map of a triangle is A z + B conj(z).
struct Derivatives {
  Complex A, B;
};

// @param at the three corners in the plane of the map; @param area > 0
Derivatives derivatives(const std::array<Complex, 3>& at, double a, double b, double c, double area) {
  // The triangle laid out with side 0 on the real axis and corner 2 at x + i y.
  const double x = (a * a + (c - b) * (c + b)) / (2 * a), y = 2 * area / a;
  const Complex along = (at[1] - at[0]) / a;       // A + B
  const Complex rest = at[2] - at[0] - x * along;  // i y (A - B)
  const Complex across(rest.imag() / y, -rest.real() / y);
  return {0.5 * (along + across), 0.5 * (along - across)};
}

struct Sums {
  double area = 0, angle = 0, flipped = 0, lost = 0;
  Sums& operator+=(const Sums& other) {
    area += other.area;
    angle += other.angle;
    flipped += other.flipped;
    lost += other.lost;
    return *this;
  }
};

// By the triangles.
void set_densities(Quality& quality, Workers& workers) {
  const Distribution densities(quality.area, quality.weights, workers);
  const double low = densities.quantile(kLow);
  quality.density_ratio = low > 0 ? densities.quantile(kHigh) / low : std::numeric_limits<double>::infinity();
  quality.median_density = densities.quantile(0.5);
}

template <class T>
void append(Array<T>& values, const Array<T>& more) {
  values.insert(values.end(), more.begin(), more.end());
}

}  // namespace

Quality quality(const mesh::Surface& surface, const Eigen::Ref<const UvArray>& uv, Workers& workers) {
  const std::size_t count = surface.triangles.size();
  Quality result{Array<double>(count), Array<double>(count), Array<char>(count), Array<double>(count)};
  Array<double>& areas = result.weights;
  const auto measure = [&](int t, Sums& sum) {
    const auto& sides = surface.triangle_edges[t];
    const double a = surface.edge_lengths[sides[0]], b = surface.edge_lengths[sides[1]],
                 c = surface.edge_lengths[sides[2]];
    result.angle[t] = 1;
    result.area[t] = areas[t] = 0;
    result.flipped[t] = 0;
    if (mesh::is_degenerate(a, b, c)) return;
    areas[t] = mesh::triangle_area(a, b, c);
    std::array<Complex, 3> at;
    for (int i = 0; i < 3; ++i) {
      const int corner = surface.triangle_corners[t][i];
      at[i] = {uv(corner, 0), uv(corner, 1)};
    }
    const auto [A, B] = derivatives(at, a, b, c, areas[t]);
    const double size_A = std::sqrt(std::norm(A)), size_B = std::sqrt(std::norm(B));
    // s1 = |A| + |B|, s2 = | |A| - |B| |; the map is flipped where |B| is larger.
    const double larger = size_A + size_B, smaller = std::abs(size_A - size_B);
    if (!(smaller > kCollapsed * larger) || !std::isfinite(larger)) {
      result.angle[t] = std::numeric_limits<double>::infinity();
      sum += {areas[t], areas[t] * kMostAngle, 0, areas[t]};
      return;
    }
    result.area[t] = larger * smaller;
    result.flipped[t] = size_B > size_A;
    result.angle[t] = larger / smaller;
    const double flipped = result.flipped[t] ? areas[t] : 0;
    sum += {areas[t], areas[t] * std::min(result.angle[t], kMostAngle), flipped, flipped};
  };
  const Sums sum = sum_over_rows(workers, static_cast<int>(count), Sums(), measure);
  result.mean_angle = sum.area > 0 ? sum.angle / sum.area : kMostAngle;
  result.flipped_part = sum.area > 0 ? sum.flipped / sum.area : 0;
  result.lost_part = sum.area > 0 ? sum.lost / sum.area : 0;
  set_densities(result, workers);
  if (!(sum.area > 0)) std::ranges::fill(areas, 1.0);  // a mean over triangles
  return result;
}

void set_evened_from(Quality& quality, const Quality& before, double evenness) {
  quality.unseen_angle = std::min(std::max(quality.mean_angle - before.mean_angle, 0.0), kUnseen * evenness);
}

Quality of_density(Quality quality, double density) {
  if (!(quality.median_density > 0)) return quality;
  const double factor = density / quality.median_density;
  for (double& area : quality.area) area *= factor;
  quality.median_density *= factor;
  return quality;
}

Quality joined(const std::vector<const Quality*>& qualities, const std::vector<double>& densities, Workers& workers) {
  if (qualities.size() == 1) return of_density(*qualities[0], densities[0]);
  Quality result;
  std::vector<const Direction*> directions;
  double overlapping = 0, all = 0, angles = 0;
  for (std::size_t k = 0; k < qualities.size(); ++k) {
    const Quality scaled = of_density(*qualities[k], densities[k]);
    append(result.angle, scaled.angle);
    append(result.area, scaled.area);
    append(result.flipped, scaled.flipped);
    append(result.weights, scaled.weights);
    const double share = std::accumulate(scaled.weights.begin(), scaled.weights.end(), 0.0);
    for (std::size_t t = 0; t < scaled.angle.size(); ++t)
      angles += scaled.weights[t] * std::min(scaled.angle[t], kMostAngle);
    all += share;
    result.flipped_part += share * scaled.flipped_part;
    result.lost_part += share * scaled.lost_part;
    result.unseen_angle += share * scaled.unseen_angle;
    overlapping += share * scaled.overlapping_part.value_or(0);
    if (scaled.overlapping_part) result.overlapping_part = 0;
    if (const auto& direction = qualities[k]->direction) directions.push_back(&*direction);
  }
  result.mean_angle = angles / all;
  for (double* part : {&result.flipped_part, &result.lost_part, &result.unseen_angle}) *part /= all;
  if (result.overlapping_part) result.overlapping_part = overlapping / all;
  set_densities(result, workers);
  if (!directions.empty()) result.direction = joined(directions);
  return result;
}

}  // namespace holomorph::uv
