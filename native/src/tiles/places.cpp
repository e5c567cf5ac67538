#include "tiles/places.h"

#include <algorithm>
#include <cmath>

#include "base/chunks.h"
#include "base/task_progress.h"

namespace holomorph::tiles {
namespace {

constexpr double kRounding = 4;  // bound of the rounding of where a row meets a side, in integer coordinates
constexpr int kNone = -1;
constexpr double kBytes = 200;            // a place, with what callers know of it
constexpr double kRow = 30, kPlace = 60;  // operations: of a row in a triangle, of a place
constexpr double kAtOnce = 1e5;           // operations between two looks at whether the search is cancelled

// Joins the places of one chunk of triangles to those before.
void append(Places& all, const Places& more) {
  all.triangles.insert(all.triangles.end(), more.triangles.begin(), more.triangles.end());
  all.barycentric.insert(all.barycentric.end(), more.barycentric.begin(), more.barycentric.end());
  all.numbers.insert(all.numbers.end(), more.numbers.begin(), more.numbers.end());
  all.flipped += more.flipped;
}

// The interval in which the row at height y meets the triangle, and a little more. look_at() decides exactly.
Point reach(const std::array<Point, 3>& p, double y) {
  double low = kLargestCoordinate, high = -kLargestCoordinate;
  for (int i = 0; i < 3; ++i) {
    const Point &a = p[i], &b = p[(i + 1) % 3];
    if (std::min(a[1], b[1]) > y || std::max(a[1], b[1]) < y) continue;
    const double t = a[1] == b[1] ? 0 : (y - a[1]) / (b[1] - a[1]), x = a[0] + t * (b[0] - a[0]);
    low = std::min(low, x);
    high = std::max(high, x);
  }
  return {low - kRounding, high + kRounding};
}

class Search {
 public:
  Search(const mesh::Surface& surface, const TileCoordinates& coordinates)
      : surface_(surface), coordinates_(coordinates), first_(surface.vertex_count, kNone) {
    for (int t = 0; t < static_cast<int>(surface.triangles.size()); ++t) {
      for (int i = 0; i < 3; ++i) {
        const int v = surface.triangles[t][i];
        if (first_[v] == kNone && is_number(coordinates.points[t][i]) && signed_area(coordinates, t) > 0) first_[v] = t;
      }
    }
  }

  // At least so many rows of places are in a triangle.
  double rows(int t) const {
    const auto [first, last] = rows_of(t);
    return std::max(last - first + 1, 0.0);
  }

  // @param report(operations) is called after each row
  template <class Report>
  void look(int t, Places& found, const Report& report) const {
    const auto& p = coordinates_.points[t];
    const double unit = coordinates_.unit, area = signed_area(coordinates_, t);
    if (area == 0) return;
    const auto [first, last] = rows_of(t);
    for (double n = first; n <= last; ++n) {
      const auto [from, to] = reach(p, n * unit);
      const double begin = std::ceil(from / unit), end = std::floor(to / unit);
      for (double m = begin; m <= end; ++m) look_at(t, {m, n}, area > 0, found);
      report(kRow + kPlace * std::max(end - begin + 1, 0.0));
    }
  }

 private:
  Point rows_of(int t) const {
    const auto& p = coordinates_.points[t];
    const auto [low, high] = std::minmax({p[0][1], p[1][1], p[2][1]});
    return {std::ceil(low / coordinates_.unit), std::floor(high / coordinates_.unit)};
  }

  bool is_number(const Point& p) const {
    return std::fmod(p[0], coordinates_.unit) == 0 && std::fmod(p[1], coordinates_.unit) == 0;
  }

  void look_at(int t, const Point& number, bool upright, Places& found) const {
    const auto& p = coordinates_.points[t];
    const Point x{number[0] * coordinates_.unit, number[1] * coordinates_.unit};
    const double turn = upright != coordinates_.is_mirrored ? 1 : -1;
    std::array<double, 3> side;  // side i is opposite corner i
    int sides = 0, last = 0;     // on which it lies
    for (int i = 0; i < 3; ++i) {
      side[i] = turn * orientation(p[(i + 1) % 3], p[(i + 2) % 3], x);
      if (side[i] < 0) return;
      if (side[i] == 0) ++sides, last = i;
    }
    // A point at a vertex or on a side lies in several triangles, and one of them has it.
    if (sides == 2 && !has_vertex(t, side)) return;
    if (sides == 1 && !has_side(t, (last + 1) % 3, turn, upright)) return;
    if (!upright) {
      ++found.flipped;
      return;
    }
    const double sum = side[0] + side[1] + side[2];
    found.triangles.push_back(t);
    found.barycentric.push_back({side[0] / sum, side[1] / sum, side[2] / sum});
    found.numbers.push_back({static_cast<std::int64_t>(number[0]), static_cast<std::int64_t>(number[1])});
  }

  bool has_vertex(int t, const std::array<double, 3>& side) const {
    const int i = side[0] > 0 ? 0 : side[1] > 0 ? 1 : 2, v = surface_.triangles[t][i];
    return first_[v] == t && !coordinates_.is_pole[v];
  }

  // Whether a point on side i, moved by (d, d^2), lies in the triangle.
  bool has_side(int t, int i, double turn, bool upright) const {
    if (upright && surface_.edge_face_count[surface_.triangle_edges[t][i]] == 1) return true;
    const Point &a = coordinates_.points[t][i], &b = coordinates_.points[t][(i + 1) % 3];
    const double x = turn * (b[0] - a[0]), y = turn * (b[1] - a[1]);
    return y != 0 ? y < 0 : x > 0;
  }

  const mesh::Surface& surface_;
  const TileCoordinates& coordinates_;
  std::vector<int> first_;  // #V the first upright triangle at a vertex whose coordinates are whole numbers
};

}  // namespace

Places places(const mesh::Surface& surface, const TileCoordinates& coordinates, Execution& execution) {
  const Search search(surface, coordinates);
  const int count = static_cast<int>(surface.triangles.size()), chunks = chunk_count(count);
  // Counted before memory is taken.
  const double most = sum_over_rows(execution.workers(), count, 0.0,
                                    [&](int t, double& sum) { sum += tiles_in(coordinates, t) + search.rows(t); });
  refuse_too_many(surface, most, kBytes, "rows and places in tiles");
  TaskProgress progress(execution, (kRow + kPlace) * most / kAtOnce / 2, kAtOnce);
  std::vector<Places> parts(chunks);
  run_throwing(execution.workers(), chunks, [&](int thread, int chunk) {
    double done = 0;
    const auto report = [&](double operations) {
      done += operations;
      for (; done >= kAtOnce; done -= kAtOnce) progress(thread);
    };
    for (int t = chunk * kChunk, end = std::min(t + kChunk, count); t < end; ++t) search.look(t, parts[chunk], report);
  });
  Places all;
  for (const Places& part : parts) append(all, part);
  return all;
}

}  // namespace holomorph::tiles
