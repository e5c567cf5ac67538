#include "mesh/spatial_order.h"

#include <algorithm>
#include <cstdint>
#include <numeric>

namespace holomorph::mesh {
namespace {

using Point = std::array<double, 3>;

constexpr int kBits = 21;  // for each coordinate
constexpr int kDigit = 16, kDigits = 4;

// The bits of a coordinate, two zeros after each.
std::uint64_t spread(std::uint64_t bits) {
  bits = (bits | bits << 32) & 0x001f00000000ffff;
  bits = (bits | bits << 16) & 0x001f0000ff0000ff;
  bits = (bits | bits << 8) & 0x100f00f00f00f00f;
  bits = (bits | bits << 4) & 0x10c30c30c30c30c3;
  return (bits | bits << 2) & 0x1249249249249249;
}

std::vector<std::uint64_t> keys(const std::vector<Point>& points) {
  Point low = points.front(), high = low;
  for (const Point& p : points) {
    for (int i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], p[i]);
      high[i] = std::max(high[i], p[i]);
    }
  }
  const double side = std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
  const double cells = side > 0 ? ((1 << kBits) - 1) / side : 0;
  std::vector<std::uint64_t> result;
  result.reserve(points.size());
  for (const Point& p : points) {
    std::uint64_t key = 0;
    for (int i = 0; i < 3; ++i) key |= spread(static_cast<std::uint64_t>((p[i] - low[i]) * cells)) << i;
    result.push_back(key);
  }
  return result;
}

}  // namespace

// By their keys, digit by digit from the lowest on.
std::vector<int> spatial_order(const std::vector<Point>& points) {
  std::vector<int> order(points.size()), next(points.size());
  std::iota(order.begin(), order.end(), 0);
  if (points.empty()) return order;
  const std::vector<std::uint64_t> key = keys(points);
  const auto digit = [&](int point, int which) { return key[point] >> (which * kDigit) & ((1 << kDigit) - 1); };
  for (int which = 0; which < kDigits; ++which) {
    std::vector<int> place((1 << kDigit) + 1, 0);
    for (const int i : order) ++place[digit(i, which) + 1];
    std::partial_sum(place.begin(), place.end(), place.begin());
    for (const int i : order) next[place[digit(i, which)]++] = i;
    order.swap(next);
  }
  return order;
}

}  // namespace holomorph::mesh
