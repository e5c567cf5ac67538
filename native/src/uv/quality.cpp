#include "uv/quality.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <cstdint>
#include <numeric>

#include "base/constants.h"
#include "base/workers.h"
#include "mesh/triangle_geometry.h"

namespace holomorph::uv {
namespace {

constexpr double kRowsPerEdge = 8, kMostRows = 4096;           // numbers of lines across a curve that are looked at
constexpr double kMostCrossings = 5e5, kMostPerEdge = 64;      // of all lines with edges, about: the larger of the two
constexpr std::size_t kAtOnce = 500'000, kAtOncePerEdge = 16;  // of these that are there at the same time

constexpr double kMeasureOperations = 2;  // to follow a crossing; how they are sorted is not counted

struct Crossing {
  double x;
  int winding;  // by which the number changes to the right of it
};

struct Lengths {
  double around = 0, twice = 0;
};

// Horizontal lines; row k lies at low + (k + 1/2) height.
class Rows {
 public:
  // @pre the curve has a height
  explicit Rows(const std::vector<Ends>& curve) : curve_(curve) {
    double high = -kInfinity, sum = 0;
    for (const auto& [start, end] : curve) {
      low_ = std::min(low_, start.imag());
      high = std::max(high, start.imag());
      sum += std::abs(end.imag() - start.imag());
    }
    extent_ = high - low_;
    const auto edges = static_cast<double>(curve.size());
    const double most = std::max(kMostCrossings, kMostPerEdge * edges);
    const double wanted = std::min({kRowsPerEdge * edges, kMostRows, std::floor(most / (sum / extent_))});
    count_ = std::max(static_cast<int>(wanted), 1);
    height_ = extent_ / count_;
    crossings_.assign(count_ + 1, 0);
    for (const Ends& edge : curve) {
      const auto [first, last] = rows_of(edge);
      ++crossings_[std::min(first, last)];
      --crossings_[std::max(first, last)];
    }
    for (int k = 0; k < count_; ++k) crossings_[k + 1] += crossings_[k];
  }

  int count() const { return count_; }

  // The row after as many from `begin` on as have room at once.
  int end_of_batch(int begin) const {
    const std::size_t most = std::max(kAtOnce, kAtOncePerEdge * curve_.size());
    std::size_t sum = 0;
    int end = begin;
    while (end < count_ && (end == begin || sum + crossings_[end] <= most)) sum += crossings_[end++];
    return end;
  }

  void measure(int begin, int end, Lengths& lengths) const {
    std::vector<std::size_t> next(end - begin + 1, 0);
    for (int k = begin; k < end; ++k) next[k - begin + 1] = next[k - begin] + crossings_[k];
    std::vector<Crossing> found(next.back());
    Execution::count(kMeasureOperations * static_cast<double>(found.size()));
    const std::vector<std::size_t> first(next);
    for (const Ends& edge : curve_) {
      const auto [from, to] = rows_of(edge);
      const int winding = from > to ? 1 : -1;
      for (int k = std::max(begin, std::min(from, to)); k < std::min(end, std::max(from, to)); ++k)
        found[next[k - begin]++] = {x_at(edge, k), winding};
    }
    for (int k = 0; k < end - begin; ++k) add(found.begin() + first[k], found.begin() + first[k + 1], lengths);
  }

 private:
  // Each end is rounded once: edges that meet there share no row and skip none.
  std::array<int, 2> rows_of(const Ends& edge) const {
    const auto row = [&](double y) { return static_cast<int>(std::ceil((y - low_) / height_ - 0.5)); };
    return {row(edge[0].imag()), row(edge[1].imag())};
  }

  double x_at(const Ends& edge, int row) const {
    const auto& [start, end] = edge;
    const double along = (low_ + (row + 0.5) * height_ - start.imag()) / (end.imag() - start.imag());
    return start.real() + along * (end.real() - start.real());
  }

  using Iterator = std::vector<Crossing>::iterator;
  static void add(Iterator begin, Iterator end, Lengths& lengths) {
    std::stable_sort(begin, end, [](const Crossing& a, const Crossing& b) { return a.x < b.x; });
    int winding = 0;
    for (Iterator at = begin; at != end && at + 1 != end; ++at) {
      winding += at->winding;
      const double length = (at + 1)->x - at->x;
      if (winding != 0) lengths.around += length;
      if (std::abs(winding) > 1) lengths.twice += length;
    }
  }

  const std::vector<Ends>& curve_;
  double low_ = kInfinity, extent_ = 0, height_ = 0;
  int count_ = 0;
  std::vector<int> crossings_;  // of each row
};

bool has_height(const std::vector<Ends>& curve) {
  const auto is_finite = [](std::complex<double> z) { return std::isfinite(z.real()) && std::isfinite(z.imag()); };
  bool differs = false;
  for (const auto& [start, end] : curve) {
    if (!is_finite(start) || !is_finite(end)) return false;
    differs = differs || start.imag() != curve.front()[0].imag();
  }
  return differs;
}

// Largest s2 / s1 of a collapsed triangle: rounding.
constexpr double kNoArea = 1e-12;

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
  quality.density_ratio = low > 0 ? densities.quantile(kHigh) / low : kInfinity;
  quality.median_density = densities.quantile(0.5);
}

template <class T>
void append(Array<T>& values, const Array<T>& more) {
  values.insert(values.end(), more.begin(), more.end());
}

}  // namespace

double overlapping_part(const std::vector<Ends>& curve, Execution& execution) {
  if (!has_height(curve)) return 0;
  const Rows rows(curve);
  Lengths lengths;
  for (int begin = 0, end = 0; begin < rows.count(); begin = end) {
    execution.report(static_cast<double>(begin) / rows.count());
    end = rows.end_of_batch(begin);
    rows.measure(begin, end, lengths);
  }
  return lengths.around > 0 ? lengths.twice / lengths.around : 0;
}

Distribution::Distribution(const Array<double>& values, const Array<double>& weights, Workers& workers)
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

double Distribution::quantile(double fraction) const {
  if (!(total_ > 0)) return 0;
  double wanted = fraction * total_;
  std::size_t k = 0;
  for (; k + 1 < classes_.size() && !(classes_[k] >= wanted && classes_[k] > 0); ++k) wanted -= classes_[k];
  std::vector<Weighted> items = items_of(k);
  return items.empty() ? 0.0 : quantile(items, wanted);
}

std::vector<Distribution::Weighted> Distribution::items_of(std::size_t k) const {
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
std::size_t Distribution::class_of(double value) const {
  return (std::bit_cast<std::uint64_t>(value) >> 48) % classes_.size();
}

// By halving the range in which the weight `wanted` is: linear time.
double Distribution::quantile(std::vector<Weighted>& items, double wanted) {
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
    if (!(smaller > kNoArea * larger) || !std::isfinite(larger)) {
      result.angle[t] = kInfinity;
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
