#include "tiles/edge_nodes.h"

#include <cmath>
#include <limits>

#include "base/chunks.h"

namespace holomorph::tiles {
namespace {

constexpr double kBytes = 150;  // a node, here and where it lies

// The lines of one coordinate that a side crosses, one after the other.
class Crossings {
 public:
  Crossings(double from, double to, double unit) : from_(from), length_(std::abs(to - from)), unit_(unit) {
    step_ = to > from ? 1 : -1;
    const double first = from / unit, last = to / unit;
    // Lines strictly between the ends: one through an end is not a crossing.
    next_ = step_ > 0 ? std::floor(first) + 1 : std::ceil(first) - 1;
    left_ = step_ > 0 ? std::ceil(last) - next_ : next_ - std::floor(last);
    const auto whole = static_cast<std::int64_t>(std::floor(first));
    code_ = first == std::floor(first) ? 2 * whole : 2 * whole + 1;
    if (length_ > 0 && is_line(code_)) code_ += step_;  // behind the start
  }

  bool done() const { return !(left_ > 0); }
  double count() const { return std::max(left_, 0.0); }
  double length() const { return length_; }
  /// From the start to the next line.
  double distance() const { return std::abs(next_ * unit_ - from_); }
  /// Between lines.
  std::int64_t code() const { return code_; }
  /// The code on the next line, behind which it then is.
  std::int64_t cross() {
    const std::int64_t line = 2 * static_cast<std::int64_t>(next_);
    code_ = line + step_;
    next_ += step_;
    --left_;
    return line;
  }

 private:
  double from_, length_, unit_, next_ = 0, left_ = 0;
  std::int64_t code_ = 0;
  int step_ = 1;
};

// Appends the nodes between a and b.
void cross(const Point& a, const Point& b, double unit, std::vector<Code>& codes, std::vector<double>& weights) {
  Crossings x(a[0], b[0], unit), y(a[1], b[1], unit);
  while (!x.done() || !y.done()) {
    // Compares distance / length of both without a division, and so exactly: less than 0 where the line of x comes
    // first.
    const double order = x.done() ? 1 : y.done() ? -1 : determinant(x.distance(), x.length(), y.distance(), y.length());
    weights.push_back(order <= 0 ? x.distance() / x.length() : y.distance() / y.length());
    Code code{x.code(), y.code()};
    if (order <= 0) code[0] = x.cross();
    if (order >= 0) code[1] = y.cross();
    codes.push_back(code);
  }
}

std::vector<int> first_sides(const mesh::Surface& surface) {
  std::vector<int> sides(surface.edges.size());
  for (int t = static_cast<int>(surface.triangles.size()) - 1; t >= 0; --t) {
    for (int i = 0; i < 3; ++i) sides[surface.triangle_edges[t][i]] = 3 * t + i;
  }
  return sides;
}

}  // namespace

Code code_of(const Point& point, double unit) {
  Code code;
  for (int i = 0; i < 2; ++i) {
    const double whole = std::floor(point[i] / unit);
    code[i] = 2 * static_cast<std::int64_t>(whole) + (whole * unit == point[i] ? 0 : 1);
  }
  return code;
}

EdgeNodes edge_nodes(const mesh::Surface& surface, const TileCoordinates& coordinates, Execution& execution) {
  const int count = static_cast<int>(surface.edges.size()), chunks = chunk_count(count);
  const double unit = coordinates.unit;
  EdgeNodes result{first_sides(surface), std::vector<int>(count + 1, 0), {}, {}};
  const auto ends = [&](int e) {
    const int t = result.sides[e] / 3, i = result.sides[e] % 3;
    return std::pair{coordinates.points[t][i], coordinates.points[t][(i + 1) % 3]};
  };
  const auto is_crossed = [&](int e) {
    const auto& [a, b] = surface.edges[e];
    return !coordinates.is_pole[a] && !coordinates.is_pole[b];
  };
  // Counted before memory is taken.
  const double most = sum_over_rows(execution.workers(), count, 0.0, [&](int e, double& sum) {
    const auto [a, b] = ends(e);
    if (is_crossed(e)) sum += Crossings(a[0], b[0], unit).count() + Crossings(a[1], b[1], unit).count();
  });
  refuse_too_many(surface, most, kBytes, "places where edges cross lines of tiles");
  std::vector<EdgeNodes> parts(chunks);
  run_throwing(execution.workers(), chunks, [&](int chunk) {
    auto& part = parts[chunk];
    for (int e = chunk * kChunk, end = std::min(e + kChunk, count); e < end; ++e) {
      const std::size_t before = part.codes.size();
      const auto [a, b] = ends(e);
      if (is_crossed(e)) cross(a, b, unit, part.codes, part.weights);
      result.offsets[e + 1] = static_cast<int>(part.codes.size() - before);
    }
  });
  for (int e = 0; e < count; ++e) result.offsets[e + 1] += result.offsets[e];
  result.codes.reserve(result.offsets.back());
  result.weights.reserve(result.offsets.back());
  for (const EdgeNodes& part : parts) {
    result.codes.insert(result.codes.end(), part.codes.begin(), part.codes.end());
    result.weights.insert(result.weights.end(), part.weights.begin(), part.weights.end());
  }
  return result;
}

}  // namespace holomorph::tiles
