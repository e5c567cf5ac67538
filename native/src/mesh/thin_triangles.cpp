#include "mesh/thin_triangles.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/chunks.h"
#include "base/double_double.h"
#include "mesh/triangle_geometry.h"

namespace holomorph::mesh {
namespace {

// Half a unit in the last place. A length is right to 2.5 of these, an energy's rounding is some 4 of its terms.
constexpr double kRounding = std::numeric_limits<double>::epsilon() / 2;
constexpr double kOfLength = 2.5 * kRounding, kOfTerm = 4 * kRounding;

std::array<double, 3> sides_at(const Metric& t, HalfedgeHandle h) {
  const HalfedgeHandle h1 = next(t.half_edges, h), h2 = next(t.half_edges, h1);
  return {t.lengths[edge_of(h)], t.lengths[edge_of(h1)], t.lengths[edge_of(h2)]};
}

double error_at(const Metric& t, HalfedgeHandle h) {
  return t.half_edges.is_boundary(h) ? 0.0 : t.errors[t.half_edges.face_handle(h).idx()];
}

// The cotangent opposite h; in a triangle with an error to all digits, of the lengths as they are.
DoubleDouble sharp_cotangent(const Metric& t, HalfedgeHandle h) {
  if (!(error_at(t, h) > 0)) return {t.cotangents[h.idx()]};
  const auto [a, b, c] = sides_at(t, h);
  const DoubleDouble others = exact_sum(b, c), apart = exact_sum(b, -c), whole{a};
  const DoubleDouble area = (whole + others) * (others - whole) * (whole - apart) * (whole + apart);  // 16 A^2
  if (!(area.high > 0)) return {t.cotangents[h.idx()]};
  const DoubleDouble above = exact_sum(b, -a) * exact_sum(b, a) + exact_product(c, c);
  return above / sqrt(area);
}

}  // namespace

// A length l_i that is off by delta_i changes the metric by 2 l_i delta_i |grad lambda_j| |grad lambda_k|; these
// gradients are l_j / 2A and l_k / 2A long.
MetricError metric_error(const std::array<double, 3>& sides) {
  const auto [a, b, c] = sides;
  const double bound = kOfLength * a * b * c * (a + b + c) / 2, area = triangle_area(a, b, c);
  return bound < area * area ? MetricError{bound / (area * area), area} : MetricError{1, std::sqrt(bound)};
}

Array<double> metric_errors(const Metric& t, Workers& workers) {
  Array<double> errors(t.half_edges.n_faces());
  for_rows(workers, static_cast<int>(errors.size()), [&](int f) {
    const HalfedgeHandle h = t.half_edges.halfedge_handle(FaceHandle(f)), h1 = next(t.half_edges, h),
                         h2 = next(t.half_edges, h1);
    const bool thin = is_thin(t.cotangents[h.idx()], t.cotangents[h1.idx()], t.cotangents[h2.idx()]);
    errors[f] = thin ? metric_error(sides_at(t, h)).relative : 0.0;
  });
  return errors;
}

bool has_error(const Metric& t, HalfedgeHandle h) {
  return !t.errors.empty() && (error_at(t, h) > 0 || error_at(t, opposite(h)) > 0);
}

std::array<MetricError, 2> errors_beside(const Metric& t, HalfedgeHandle h) {
  const auto at = [&t](HalfedgeHandle side) {
    return MetricError{error_at(t, side), metric_error(sides_at(t, side)).area};
  };
  return {at(h), at(opposite(h))};
}

std::array<double, 2> mixed_errors(const Metric& t, HalfedgeHandle h, const std::array<MetricError, 2>& before) {
  const auto& [first, second] = before;
  const double mean = (first.relative * first.area + second.relative * second.area) / (first.area + second.area);
  const auto mixed = [&](HalfedgeHandle side) {
    return std::min(1.0, mean + metric_error(sides_at(t, side)).relative);
  };
  return {mixed(h), mixed(opposite(h))};
}

void sharpen_weights(const Metric& t, Array<double>& weights, Workers& workers) {
  for_rows(workers, static_cast<int>(weights.size()), [&](int e) {
    const HalfedgeHandle h(2 * e);
    if (has_error(t, h)) weights[e] = 0.5 * (sharp_cotangent(t, h) + sharp_cotangent(t, opposite(h))).value();
  });
}

Array<double> energy_errors(const Metric& t, const Array<double>& weights, Workers& workers) {
  if (t.errors.empty()) return {};
  Array<double> errors(weights.size());
  for_rows(workers, static_cast<int>(errors.size()), [&](int e) {
    errors[e] = 0;
    for (const HalfedgeHandle h : {HalfedgeHandle(2 * e), HalfedgeHandle(2 * e + 1)}) {
      const double error = error_at(t, h);
      if (error > 0) errors[e] += kOfTerm * std::abs(weights[e]) + 0.5 * error * sharp_cotangent(t, h).value();
    }
  });
  return errors;
}

}  // namespace holomorph::mesh
