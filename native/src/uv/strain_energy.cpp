#include "uv/strain_energy.h"

#include <algorithm>
#include <cmath>

#include "base/workers.h"
#include "mesh/triangle_geometry.h"

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

// Bounds of the stiffness by area, relative to where the map has its mean size. At a branch point |a| vanishes, and the
// stiffness would be infinite.
constexpr double kMostStiff = 1e6, kLeastStiff = 1e-6;

// Factor of the energy of a triangle each time that it is still flipped.
constexpr double kEmphasis = 8;

// Triangles thinner than this, area by squared longest side, weigh less in the Laplacian: solvers do not bear their
// weights, and the energy itself has them right. Other slivers count in full. If they did not, steps would be too long
// there, and a few slivers would shorten those of all.
constexpr double kThinArea = 1e-6;
constexpr double kOperations = 80;  // for each triangle

struct LogSum {
  double area = 0, log = 0;
  LogSum& operator+=(const LogSum& other) {
    area += other.area;
    log += other.log;
    return *this;
  }
};

// Gradients of the hat functions of corners 1 and 2 on a triangle with corners at 0, `first` and `second`: the opposite
// side, turned by a quarter, over twice the area.
std::array<Complex, 2> hat_gradients(Complex first, Complex second) {
  const double twice_area = (std::conj(first) * second).imag();
  const Complex i(0, 1);
  return {-i * second / twice_area, i * first / twice_area};
}

// Corner 0 at 0, corner 1 on the real axis.
std::array<Complex, 2> laid_out(double a, double b, double c, double area) {
  return {Complex(a), Complex((a * a + (c - b) * (c + b)) / (2 * a), 2 * area / a)};
}

// Below 1 where a triangle is thin. @param gradients of all three corners; the longest is one over the least height
double thinness(const std::array<Complex, 3>& gradients) {
  const double area = 0.5 / std::abs((std::conj(gradients[1]) * gradients[2]).imag());
  const double steepest = std::max({std::norm(gradients[0]), std::norm(gradients[1]), std::norm(gradients[2])});
  return std::min(1.0, 1 / (4 * kThinArea * area * steepest));
}

double dot(Complex a, Complex b) { return a.real() * b.real() + a.imag() * b.imag(); }

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

// Lays the triangle out in the plane of z, with the derivatives of the map there. The area stays 0 if it does not
// count.
void StrainEnergy::Triangle::lay_out(const mesh::Surface& surface, int t, const uv::UvArray& uv) {
  const auto [e0, e1, e2] = surface.triangle_edges[t];
  const double side = surface.edge_lengths[e0], next = surface.edge_lengths[e1], last = surface.edge_lengths[e2];
  if (mesh::is_degenerate(side, next, last)) return;
  const auto at = [&](int k) {
    const int corner = surface.triangle_corners[t][k];
    return Complex(uv(corner, 0), uv(corner, 1));
  };
  const Complex first = at(1) - at(0), second = at(2) - at(0);
  // At a pole z is the UV itself, so that strain is measured from the map without delta. A triangle that is flipped in
  // that map does not count.
  if (at_pole && !((std::conj(first) * second).imag() > 0)) return;
  const double whole = mesh::triangle_area(side, next, last);
  const auto [x, y] = at_pole ? std::array<Complex, 2>{first, second} : laid_out(side, next, last, whole);
  gradients = hat_gradients(x, y);
  // The Wirtinger derivatives d/dz and d/d conj(z) of the linear map.
  a = 0.5 * (first * std::conj(gradients[0]) + second * std::conj(gradients[1]));
  b = 0.5 * (first * gradients[0] + second * gradients[1]);
  if (std::norm(a) > 0 && std::isfinite(std::norm(a) + std::norm(b))) area = whole;
}

StrainEnergy::StrainEnergy(const mesh::Surface& surface, const uv::UvArray& uv, const std::vector<int>& poles,
                           const CornerTurns& turns, Workers& workers)
    : triangles_(surface.triangles.size()), turned_(turns.size()) {
  std::vector<char> is_pole(surface.vertex_count, 0);
  for (const int v : poles) is_pole[v] = 1;
  const auto count = static_cast<int>(triangles_.size());
  const LogSum sum = sum_over_rows(workers, count, LogSum(), [&](int t, LogSum& part) {
    Triangle& triangle = triangles_[t] = Triangle();
    triangle.vertices = surface.triangles[t];
    triangle.at_pole = std::ranges::any_of(triangle.vertices, [&](int v) { return is_pole[v]; });
    triangle.lay_out(surface, t, uv);
    if (!turns.empty()) {
      // The energy does not change where the map is turned back by what turns corner 0.
      const Complex back = std::conj(turns[t][0]);
      turned_[t] = {turns[t][1] * back, turns[t][2] * back};
      triangle.a *= back, triangle.b *= back;
    }
    // The mean of ln |a|^2 by area, which is ln of the mean size where the map is conformal.
    if (!triangle.at_pole && triangle.area > 0)
      part += {triangle.area, triangle.area * std::log(std::norm(triangle.a))};
  });
  if (sum.area > 0) {
    log_size_ = sum.log / sum.area;
    whole_area_ = sum.area;
  }
  for_rows(workers, count, [&](int t) {
    triangles_[t].area /= whole_area_;
    if (!triangles_[t].at_pole) triangles_[t].log_size = log_size_;
  });
  find_stars(surface.vertex_count);
}

void StrainEnergy::find_stars(int vertex_count) {
  star_starts_.assign(vertex_count + 1, 0);
  for (const Triangle& triangle : triangles_) {
    for (const int v : triangle.vertices) ++star_starts_[v + 1];
  }
  for (int v = 0; v < vertex_count; ++v) star_starts_[v + 1] += star_starts_[v];
  star_corners_.resize(3 * triangles_.size());
  std::vector<int> next(star_starts_.begin(), star_starts_.end() - 1);
  for (int t = 0; t < static_cast<int>(triangles_.size()); ++t) {
    for (int k = 0; k < 3; ++k) star_corners_[next[triangles_[t].vertices[k]]++] = 3 * t + k;
  }
}

StrainEnergy::Derivatives StrainEnergy::derivatives(std::size_t t, const Function& function) const {
  const Triangle& triangle = triangles_[t];
  const auto& v = triangle.vertices;
  const auto [g1, g2] = triangle.gradients;
  const auto [turned_1, turned_2] = turned(t);
  const Complex along_1 = turned_1 * function[v[1]] - function[v[0]];
  const Complex along_2 = turned_2 * function[v[2]] - function[v[0]];
  return {triangle.a + 0.5 * (along_1 * std::conj(g1) + along_2 * std::conj(g2)),
          triangle.b + 0.5 * (along_1 * g1 + along_2 * g2)};
}

bool StrainEnergy::flipped(const Triangle& triangle, const Derivatives& map) {
  return (std::norm(map.b) > std::norm(map.a)) != triangle.reversed;
}

bool StrainEnergy::flips(std::size_t t, const Function& function) const {
  return triangles_[t].area > 0 && flipped(triangles_[t], derivatives(t, function));
}

StrainEnergy::Value StrainEnergy::operator()(const Function& delta, double lambda, Function& gradient,
                                             Function& at_corners, Workers& workers) const {
  Execution::count(kOperations * static_cast<double>(triangles_.size()));
  at_corners.resize(3 * triangles_.size());
  const Value value = sum_over_rows(workers, static_cast<int>(triangles_.size()), Value(), [&](int t, Value& sum) {
    const Triangle& triangle = triangles_[t];
    Complex* const at = &at_corners[3 * static_cast<std::size_t>(t)];
    at[0] = at[1] = at[2] = 0;
    if (!(triangle.area > 0)) return;
    const Derivatives map = derivatives(t, delta);
    const Turned turns = turned(t);
    const TriangleEnergy local =
        triangle_energy(std::norm(map.a), std::norm(map.b), triangle.lambda(lambda), triangle.log_size);
    const double weight = triangle.area * triangle.emphasis;
    sum += {weight * local.value, flipped(triangle, map) ? triangle.area : 0};
    // By the chain rule through a and b, which are linear in the corner values. The three hat gradients sum to 0.
    const Complex by_a = 0.5 * weight * local.by_a * map.a, by_b = 0.5 * weight * local.by_b * map.b;
    for (const int k : {1, 2}) {
      const Complex g = triangle.gradients[k - 1];
      at[k] = by_a * g + by_b * std::conj(g);
      at[0] -= at[k];
      at[k] *= std::conj(turns[k - 1]);
    }
  });
  gradient.resize(vertex_count());
  for_rows(workers, vertex_count(), [&](int v) {
    // Each vertex gathers from its corners in a fixed order: the same bits at any number of threads.
    Complex sum = 0;
    for (int i = star_starts_[v]; i < star_starts_[v + 1]; ++i) sum += at_corners[star_corners_[i]];
    gradient[v] = sum;
  });
  return value;
}

void StrainEnergy::emphasise_flipped(const Function& delta, Workers& workers) {
  for_rows(workers, static_cast<int>(triangles_.size()), [&](int t) {
    if (flips(t, delta)) triangles_[t].emphasis *= kEmphasis;
  });
}

double StrainEnergy::stiffness_of(std::size_t t, const Function& delta, double lambda) const {
  const Triangle& triangle = triangles_[t];
  const Derivatives map = derivatives(t, delta);
  const double size = std::norm(map.a), ratio = std::sqrt(std::norm(map.b) / size);
  const double stiff = stiffness(ratio, std::log(size) - triangle.log_size, triangle.lambda(lambda)) / size;
  const auto [g1, g2] = triangle.gradients;
  const double weighed = triangle.area * triangle.emphasis * stiff * thinness({-(g1 + g2), g1, g2});
  return triangle.at_pole ? weighed : std::min(weighed, kMostStiff * std::exp(-log_size_) * triangle.area);
}

Array<double> StrainEnergy::edge_weights(const mesh::Surface& surface, const Function& delta, double lambda) const {
  Array<double> weights(surface.edges.size());
  // Keeps the system regular if all triangle weights are 0.
  std::fill(weights.begin(), weights.end(), kLeastStiff * std::exp(-log_size_) / whole_area_);
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const Triangle& triangle = triangles_[t];
    if (!(triangle.area > 0)) continue;
    const auto [g1, g2] = triangle.gradients;
    const std::array<Complex, 3> g = {-(g1 + g2), g1, g2};
    const double stiff = stiffness_of(t, delta, lambda);
    // -grad phi_i . grad phi_j times the area is the cotangent weight of the side from i to j.
    for (int k = 0; k < 3; ++k) weights[surface.triangle_edges[t][k]] -= stiff * dot(g[k], g[(k + 1) % 3]);
  }
  return weights;
}

Eigen::SparseMatrix<double> StrainEnergy::laplacian(const Function& delta, double lambda, int count) const {
  std::vector<Eigen::Triplet<double>> entries;
  const bool turn = std::ranges::any_of(turned_, [](const Turned& turned) { return turned != Turned{1, 1}; });
  const int parts = turn ? 2 : 1;
  for (int v = 0; v < parts * count; ++v) entries.emplace_back(v, v, kLeastStiff * std::exp(-log_size_) / whole_area_);
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const Triangle& triangle = triangles_[t];
    if (!(triangle.area > 0)) continue;
    const auto [g1, g2] = triangle.gradients;
    const std::array<Complex, 3> g = {-(g1 + g2), g1, g2};
    const double stiff = stiffness_of(t, delta, lambda);
    const auto [turned_1, turned_2] = turned(t);
    const std::array<Complex, 3> turns = {1, turned_1, turned_2};
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        const int row = triangle.vertices[i], column = triangle.vertices[j];
        if (row < column || row >= count) continue;
        const double weight = stiff * dot(g[i], g[j]);
        if (parts == 1) {
          entries.emplace_back(row, column, weight);
          continue;
        }
        const Complex turned = std::conj(turns[i]) * turns[j];
        for (const int part : {0, 1}) {
          entries.emplace_back(2 * row + part, 2 * column + part, weight * turned.real());
          const int other = 2 * column + 1 - part;
          if (row > column) entries.emplace_back(2 * row + part, other, (part ? 1 : -1) * weight * turned.imag());
        }
      }
    }
  }
  Eigen::SparseMatrix<double> result(parts * count, parts * count);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

}  // namespace holomorph::uv
