#include "tiles/lines_and_places.h"

#include <algorithm>
#include <cmath>

#include "base/task_progress.h"
#include "base/workers.h"
#include "tiles/triangle_cut.h"

namespace holomorph::tiles {
namespace {

constexpr double kRounding = 4;           // bound of the rounding of where a row meets a side, in integer coordinates
constexpr double kBytesOfPlace = 200;     // a place, with what callers know of it
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

using Segment = std::array<int, 2>;  // from a node to a node, with what is less on the left

// The segments of lines across the triangles of a chunk, and along their sides. A side belongs to the first triangle at
// its edge.
std::vector<Segment> segments(const mesh::Surface& surface, const TileCoordinates& coordinates,
                              const EdgeNodes& edge_nodes, int begin, int end, const std::function<void()>& report) {
  TriangleCut cut(surface, coordinates, edge_nodes, Pattern::columns, report);
  std::vector<Segment> result;
  for (int t = begin; t < end; ++t) {
    const auto& pieces = cut.cut(t);
    // The last side of a piece that was cut away is the cut.
    for (std::size_t p = 0; p + 1 < pieces.size(); ++p)
      result.push_back({pieces[p].back().node, pieces[p].front().node});
    const auto code = [&](int i) { return code_of(coordinates.points[t][i % 3], coordinates.unit)[0]; };
    for (int i = 0; i < 3; ++i) {
      const auto& [a, b] = std::pair{surface.triangles[t][i], surface.triangles[t][(i + 1) % 3]};
      const bool is_first = edge_nodes.sides[surface.triangle_edges[t][i]] == 3 * t + i;
      const bool is_spoke = coordinates.is_pole[a] || coordinates.is_pole[b];
      if (!is_first || is_spoke || code(i) != code(i + 1) || !is_line(code(i))) continue;
      result.push_back(code(i + 2) < code(i) ? Segment{a, b} : Segment{b, a});
    }
  }
  return result;
}

// Chains segments at nodes where exactly two meet.
class Chains {
 public:
  Chains(const std::vector<Segment>& segments, int nodes) : segments_(segments), offsets_(nodes + 1, 0) {
    for (const auto& segment : segments) {
      for (const int node : segment) ++offsets_[node + 1];
    }
    for (int n = 0; n < nodes; ++n) offsets_[n + 1] += offsets_[n];
    at_node_.resize(2 * segments.size());
    std::vector<int> next(offsets_.begin(), offsets_.end() - 1);
    for (int s = 0; s < std::ssize(segments); ++s) {
      for (const int node : segments[s]) at_node_[next[node]++] = s;
    }
  }

  /// follow(nodes, is_closed) for each chain: those with ends first.
  template <class Follow>
  void run(const Follow& follow) {
    std::vector<char> seen(segments_.size(), 0);
    const auto nodes = static_cast<int>(offsets_.size()) - 1;
    // First the chains with ends, where not exactly two segments meet. What is left after them are closed chains.
    for (const bool closed : {false, true}) {
      for (int n = 0; n < nodes; ++n) {
        if (!closed && degree(n) == 2) continue;
        for (int i = offsets_[n]; i < offsets_[n + 1]; ++i) {
          if (!seen[at_node_[i]]) follow(chain(n, at_node_[i], seen), closed);
        }
      }
    }
  }

 private:
  int degree(int node) const { return offsets_[node + 1] - offsets_[node]; }

  std::vector<int> chain(int node, int segment, std::vector<char>& seen) const {
    const int start = node;
    std::vector<int> result{node};
    std::ptrdiff_t along = 0;
    while (true) {
      seen[segment] = 1;
      const auto& [a, b] = segments_[segment];
      along += node == a ? 1 : -1;
      node = node == a ? b : a;
      if (node == start && degree(node) == 2) break;
      result.push_back(node);
      if (degree(node) != 2) break;
      const int first = at_node_[offsets_[node]];
      segment = first == segment ? at_node_[offsets_[node] + 1] : first;
    }
    // Segments may disagree where triangles are flipped: the majority decides the direction.
    if (along < 0) std::reverse(result.begin(), result.end());
    return result;
  }

  const std::vector<Segment>& segments_;
  std::vector<int> offsets_, at_node_;  // segments at each node
};

}  // namespace

Places places(const mesh::Surface& surface, const TileCoordinates& coordinates, Execution& execution) {
  const Search search(surface, coordinates);
  const int count = static_cast<int>(surface.triangles.size()), chunks = chunk_count(count);
  // Counted before memory is taken.
  const double most = sum_over_rows(execution.workers(), count, 0.0,
                                    [&](int t, double& sum) { sum += tiles_in(coordinates, t) + search.rows(t); });
  refuse_too_many(surface, most, kBytesOfPlace, "rows and places in tiles");
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

Lines lines(const mesh::Surface& surface, const TileCoordinates& coordinates, Execution& execution) {
  const EdgeNodes nodes = edge_nodes(surface, coordinates, execution);
  const int count = static_cast<int>(surface.triangles.size()), chunks = chunk_count(count);
  std::vector<std::vector<Segment>> parts(chunks);
  const double expected = static_cast<double>(nodes.codes.size()) + count;
  TaskProgress progress(execution, expected / kReportedPieces / 2, kReportedPieces * kPieceWork);
  run_throwing(execution.workers(), chunks, [&](int thread, int chunk) {
    parts[chunk] = segments(surface, coordinates, nodes, chunk * kChunk, std::min((chunk + 1) * kChunk, count),
                            [&] { progress(thread); });
  });
  std::vector<Segment> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  if (coordinates.is_mirrored) {
    for (Segment& segment : all) std::swap(segment[0], segment[1]);
  }
  const Locations places = edge_locations(surface, nodes);
  execution.report(1);
  Lines result;
  Chains(all, static_cast<int>(places.triangles.size())).run([&](const std::vector<int>& chain, bool is_closed) {
    for (const int node : chain) result.points.push_back(places.triangles[node], places.barycentric[node]);
    result.offsets.push_back(static_cast<int>(result.points.triangles.size()));
    result.is_closed.push_back(is_closed);
  });
  return result;
}

}  // namespace holomorph::tiles
