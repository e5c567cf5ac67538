#include "evening/strain_energy.h"

#include <algorithm>
#include <cmath>

#include "base/chunks.h"
#include "mesh/triangle_geometry.h"

namespace holomorph::evening {
namespace {

// Up to this ratio of |b| to |a| the energy is that of the logarithmic strain, s1 / s2 up to 6; beyond, where it would
// become infinite, it goes on as a parabola. So a triangle may flip on the way, and is driven back.
constexpr double kStrained = 0.7;

// Weights relative to their mean: where a map branches its size is 0, and where it does not count it is not wanted.
constexpr double kMostWeight = 1e4, kLeastWeight = 1e-6;

constexpr double kEmphasis = 8;

// Triangles thinner than this, area by squared longest side, weigh in the Laplacian as if they were larger: theirs are
// weights that solvers do not like, and the energy itself has them right.
constexpr double kThinArea = 1e-2;

struct LogSum {
  double area = 0, log = 0;
  LogSum& operator+=(const LogSum& other) {
    area += other.area;
    log += other.log;
    return *this;
  }
};

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

// The energy of a triangle of area 1, and its derivatives by |a| and |b| over |a| and |b|.
struct Local {
  double value, by_a, by_b;
};

Local local_energy(double square_a, double square_b, double lambda, double log_size) {
  const double ratio = std::sqrt(square_b / square_a), strained = std::min(ratio, kStrained);
  const double size = std::log(square_a * (1 - strained * strained)) - log_size;
  const auto [shear, slope] = squared_shear(ratio);
  double by_ratio = (1 - lambda) * slope;  // over the ratio
  if (ratio < kStrained) by_ratio -= 4 * lambda * size / (1 - ratio * ratio);
  return {(1 - lambda) * shear + lambda * size * size, (4 * lambda * size - ratio * ratio * by_ratio) / square_a,
          by_ratio / square_a};
}

// How much larger second derivatives are than where the map is conformal and of the mean size.
double stiffness(double ratio, double size, double lambda) {
  const double strained = std::min(ratio, kStrained), open = 1 - strained * strained;
  const double curvature = 8 * (1 + 2 * strained * std::atanh(strained)) / (open * open);
  const double slope = squared_shear(ratio).slope;
  const double shear = (curvature * (1 + ratio * ratio) + 2 * slope * ratio * ratio) / 8;
  return (1 - lambda) * shear + lambda * (1 + std::max(0.0, -size / 2));
}

// Gradients of the hat functions of corners 1 and 2 on a triangle with corners at 0, `first` and `second`: the opposite
// side, turned by a quarter, over twice the area.
std::array<Complex, 2> hat_gradients(Complex first, Complex second) {
  const double twice_area = (std::conj(first) * second).imag();
  const Complex i(0, 1);
  return {-i * second / twice_area, i * first / twice_area};
}

double laid_out_area(const std::array<Complex, 2>& gradients) {
  return 0.5 / (std::conj(gradients[0]) * gradients[1]).imag();
}

// Corner 0 at 0, corner 1 on the real axis.
std::array<Complex, 2> laid_out(double a, double b, double c, double area) {
  return {Complex(a), Complex((a * a + (c - b) * (c + b)) / (2 * a), 2 * area / a)};
}

}  // namespace

StrainEnergy::StrainEnergy(const mesh::Surface& surface, const uv::UvArray& uv, const std::vector<int>& poles,
                           Workers& workers)
    : surface_(surface), triangles_(surface.triangles.size()) {
  std::vector<char> is_pole(surface.vertex_count, 0);
  for (const int v : poles) is_pole[v] = 1;
  const auto count = static_cast<int>(triangles_.size());
  const LogSum sum = sum_over_rows(workers, count, LogSum(), [&](int t, LogSum& part) {
    Triangle& triangle = triangles_[t] = Triangle();
    const auto [e0, e1, e2] = surface.triangle_edges[t];
    const double a = surface.edge_lengths[e0], b = surface.edge_lengths[e1], c = surface.edge_lengths[e2];
    if (mesh::is_degenerate(a, b, c)) return;
    const auto at = [&](int k) {
      const int corner = surface.triangle_corners[t][k];
      return Complex(uv(corner, 0), uv(corner, 1));
    };
    const Complex first = at(1) - at(0), second = at(2) - at(0);
    const double area = mesh::triangle_area(a, b, c);
    const auto& v = surface.triangles[t];
    triangle.at_pole = is_pole[v[0]] || is_pole[v[1]] || is_pole[v[2]];
    const auto [x, y] = triangle.at_pole ? std::array<Complex, 2>{first, second} : laid_out(a, b, c, area);
    const auto [g1, g2] = triangle.gradients = hat_gradients(x, y);
    triangle.a = 0.5 * (first * std::conj(g1) + second * std::conj(g2));
    triangle.b = 0.5 * (first * g1 + second * g2);
    const double size = std::norm(triangle.a);
    const bool is_flipped = triangle.at_pole && !((std::conj(first) * second).imag() > 0);
    if (!(size > 0) || !std::isfinite(size + std::norm(triangle.b)) || is_flipped) return;
    triangle.area = area;
    if (!triangle.at_pole) part += {area, area * std::log(size)};
  });
  if (sum.area > 0) {
    area_ = sum.area;
    log_size_ = sum.log / sum.area;
  }
  for_rows(workers, count, [&](int t) { triangles_[t].area /= area_; });

  star_starts_.assign(surface.vertex_count + 1, 0);
  for (const auto& triangle : surface.triangles) {
    for (const int v : triangle) ++star_starts_[v + 1];
  }
  for (int v = 0; v < surface.vertex_count; ++v) star_starts_[v + 1] += star_starts_[v];
  star_corners_.resize(3 * triangles_.size());
  std::vector<int> next(star_starts_.begin(), star_starts_.end() - 1);
  for (int t = 0; t < count; ++t) {
    for (int k = 0; k < 3; ++k) star_corners_[next[surface.triangles[t][k]]++] = 3 * t + k;
  }
}

StrainEnergy::Derivatives StrainEnergy::derivatives(int triangle, const Function& function) const {
  const auto& v = surface_.triangles[triangle];
  const auto [g1, g2] = triangles_[triangle].gradients;
  const Complex along_1 = function[v[1]] - function[v[0]], along_2 = function[v[2]] - function[v[0]];
  return {0.5 * (along_1 * std::conj(g1) + along_2 * std::conj(g2)), 0.5 * (along_1 * g1 + along_2 * g2)};
}

StrainEnergy::Value StrainEnergy::operator()(const Function& delta, double lambda, Function& gradient,
                                             Function& at_corners, Workers& workers) const {
  at_corners.resize(3 * triangles_.size());
  const Value value = sum_over_rows(workers, static_cast<int>(triangles_.size()), Value(), [&](int t, Value& sum) {
    const Triangle& triangle = triangles_[t];
    Complex* const at = &at_corners[3 * static_cast<std::size_t>(t)];
    at[0] = at[1] = at[2] = 0;
    if (!(triangle.area > 0)) return;
    const Derivatives change = derivatives(t, delta);
    const Complex a = triangle.a + change.a, b = triangle.b + change.b;
    const double square_a = std::norm(a), square_b = std::norm(b);
    const Local local = local_energy(square_a, square_b, lambda, log_size(triangle));
    const double weight = triangle.area * triangle.emphasis;
    sum += {weight * local.value, square_b > square_a ? triangle.area : 0};
    const Complex by_a = 0.5 * weight * local.by_a * a, by_b = 0.5 * weight * local.by_b * b;
    for (const int k : {1, 2}) {
      const Complex g = triangle.gradients[k - 1];
      at[k] = by_a * g + by_b * std::conj(g);
      at[0] -= at[k];
    }
  });
  gradient.resize(surface_.vertex_count);
  for_rows(workers, surface_.vertex_count, [&](int v) {
    Complex sum = 0;
    for (int i = star_starts_[v]; i < star_starts_[v + 1]; ++i) sum += at_corners[star_corners_[i]];
    gradient[v] = sum;
  });
  return value;
}

void StrainEnergy::emphasise_flipped(const Function& delta, Workers& workers) {
  for_rows(workers, static_cast<int>(triangles_.size()), [&](int t) {
    Triangle& triangle = triangles_[t];
    const Derivatives change = derivatives(t, delta);
    if (triangle.area > 0 && std::norm(triangle.b + change.b) > std::norm(triangle.a + change.a))
      triangle.emphasis *= kEmphasis;
  });
}

Array<double> StrainEnergy::weights(const Function& delta, double lambda) const {
  const double mean = std::exp(-log_size_) / area_;
  Array<double> weights(surface_.edges.size());
  std::fill(weights.begin(), weights.end(), 0.0);
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const Triangle& triangle = triangles_[t];
    const auto& sides = surface_.triangle_edges[t];
    const double x = surface_.edge_lengths[sides[0]], y = surface_.edge_lengths[sides[1]],
                 z = surface_.edge_lengths[sides[2]], longest = std::max({x, y, z});
    const double area = std::max(mesh::triangle_area(x, y, z), kThinArea * longest * longest);
    double weight = kLeastWeight * mean;
    if (triangle.area > 0) {
      const Derivatives change = derivatives(static_cast<int>(t), delta);
      const double size = std::norm(triangle.a + change.a), ratio = std::sqrt(std::norm(triangle.b + change.b) / size);
      const double stiff = stiffness(ratio, std::log(size) - log_size(triangle), lambda) / size;
      weight = std::clamp(stiff * triangle.area * triangle.emphasis / laid_out_area(triangle.gradients), weight,
                          kMostWeight * mean);
    }
    weights[sides[0]] += weight * mesh::cotangent(x, y, z, area) / 2;
    weights[sides[1]] += weight * mesh::cotangent(y, z, x, area) / 2;
    weights[sides[2]] += weight * mesh::cotangent(z, x, y, area) / 2;
  }
  return weights;
}

}  // namespace holomorph::evening
