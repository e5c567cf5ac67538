#include "uv/quality.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <cstdint>
#include <limits>

#include "base/chunks.h"
#include "mesh/triangle_geometry.h"

namespace holomorph::uv {
namespace {

using Complex = std::complex<double>;

// Largest s2 / s1 of a collapsed triangle: rounding.
constexpr double kCollapsed = 1e-12;

struct Weighted {
  double value, weight;
};

// The value below which the weight `wanted` lies, by halving the range in which it is: linear time.
double weighted_quantile(std::vector<Weighted>& items, double wanted) {
  auto begin = items.begin(), end = items.end();
  while (end - begin > 1) {
    const auto middle = begin + (end - begin) / 2;
    std::nth_element(begin, middle, end, [](const Weighted& a, const Weighted& b) { return a.value < b.value; });
    double below = 0;
    for (auto item = begin; item != middle; ++item) below += item->weight;
    if (below >= wanted) {
      end = middle;
    } else {
      wanted -= below;
      begin = middle;
    }
  }
  return begin->value;
}

// Weights of values >= 0 by the leading bits of the values, of which there are 16 classes in each octave: they are in
// the order of the values. Only the items of the class with a quantile are visited again. Fewer values than classes
// are all in one, which is visited sooner than all classes.
class Distribution {
 public:
  Distribution(const Array<double>& values, const Array<double>& weights, Workers& workers)
      : values_(values),
        weights_(weights),
        workers_(workers),
        parts_(values.size() < kMost ? 1 : 8),
        classes_(parts_ > 1 ? kMost : 1, 0.0) {
    std::vector<std::vector<double>> parts(parts_, classes_);
    workers.run(parts_, [&](int, int part) {
      for (std::size_t i = begin(part); i < begin(part + 1); ++i) parts[part][class_of(values[i])] += weights[i];
    });
    for (const auto& part : parts) {
      for (std::size_t k = 0; k < classes_.size(); ++k) classes_[k] += part[k];
    }
    for (const double weight : classes_) total_ += weight;
  }

  /// The value below which this fraction of the total weight lies.
  double quantile(double fraction) const {
    double wanted = fraction * total_;
    std::size_t k = 0;
    for (; k + 1 < classes_.size() && !(classes_[k] >= wanted && classes_[k] > 0); ++k) wanted -= classes_[k];
    std::vector<Weighted> items = items_of(k);
    return items.empty() ? 0.0 : weighted_quantile(items, wanted);
  }

 private:
  static constexpr int kMost = 1 << 15;
  std::size_t begin(int part) const { return values_.size() * part / parts_; }

  std::vector<Weighted> items_of(std::size_t k) const {
    std::vector<std::vector<Weighted>> parts(parts_);
    run_throwing(workers_, parts_, [&](int part) {
      for (std::size_t i = begin(part); i < begin(part + 1); ++i) {
        if (class_of(values_[i]) == k) parts[part].push_back({values_[i], weights_[i]});
      }
    });
    std::vector<Weighted> items;
    for (const auto& part : parts) items.insert(items.end(), part.begin(), part.end());
    return items;
  }

  // The sign, the exponent and four bits of the mantissa: 16 classes in an octave.
  std::size_t class_of(double value) const { return (std::bit_cast<std::uint64_t>(value) >> 48) % classes_.size(); }

  const Array<double>& values_;
  const Array<double>& weights_;
  Workers& workers_;
  const int parts_;  // number of parts processed in parallel
  std::vector<double> classes_;
  double total_ = 0;
};

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

struct AngleSum {
  double area = 0, angle = 0;
  AngleSum& operator+=(const AngleSum& other) {
    area += other.area;
    angle += other.angle;
    return *this;
  }
};

}  // namespace

Quality quality(const mesh::Surface& surface, const Eigen::Ref<const UvArray>& uv, Workers& workers) {
  const std::size_t count = surface.triangles.size();
  Quality result{Array<double>(count), Array<double>(count), Array<char>(count)};
  Array<double> areas(count);
  const auto measure = [&](int t, AngleSum& sum) {
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
      sum += {areas[t], areas[t] * kMostAngle};
      return;
    }
    result.area[t] = larger * smaller;
    result.flipped[t] = size_B > size_A;
    result.angle[t] = larger / smaller;
    sum += {areas[t], areas[t] * std::min(result.angle[t], kMostAngle)};
  };
  const AngleSum sum = sum_over_rows(workers, static_cast<int>(count), AngleSum(), measure);
  result.mean_angle = sum.area > 0 ? sum.angle / sum.area : kMostAngle;
  const Distribution densities(result.area, areas, workers);
  const double low = densities.quantile(0.05);
  result.density_ratio = low > 0 ? densities.quantile(0.95) / low : std::numeric_limits<double>::infinity();
  result.median_density = densities.quantile(0.5);
  return result;
}

}  // namespace holomorph::uv
