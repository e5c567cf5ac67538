#include "uv/overlap.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace holomorph::uv {
namespace {

constexpr double kRowsPerEdge = 8, kMostRows = 4096;           // numbers of lines across a curve that are looked at
constexpr double kMostCrossings = 5e5, kMostPerEdge = 64;      // of all lines with edges, about: the larger of the two
constexpr std::size_t kAtOnce = 500'000, kAtOncePerEdge = 16;  // of these that are there at the same time

constexpr double kOperations = 2;  // to follow a crossing; how they are sorted is not counted

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
    double high = -std::numeric_limits<double>::infinity(), sum = 0;
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
    Execution::count(kOperations * static_cast<double>(found.size()));
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
  double low_ = std::numeric_limits<double>::infinity(), extent_ = 0, height_ = 0;
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

}  // namespace holomorph::uv
