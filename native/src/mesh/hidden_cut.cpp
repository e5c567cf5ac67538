#include "mesh/hidden_cut.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "mesh/cut_open.h"
#include "mesh/triangle_tree.h"

namespace holomorph::mesh {
namespace {

constexpr int kTips = 4;         // head, a hand and two feet, as it were: the others bend less
constexpr double kUnseen = 0.1;  // exposure that a path is charged where nothing sees it: else it would wander
constexpr int kAtOnce = 1000;    // vertices between two looks at whether the work is cancelled

// The exposure of all vertices, #V.
std::vector<double> exposures(const Surface& surface, const std::optional<std::array<double, 3>>& up,
                              Execution& execution) {
  AmbientOcclusion exposure(surface, up);
  std::vector<double> result(surface.vertex_count);
  for (int begin = 0; begin < surface.vertex_count; begin += kAtOnce) {
    execution.report(0);
    std::vector<int> some(std::min(kAtOnce, surface.vertex_count - begin));
    std::iota(some.begin(), some.end(), begin);
    exposure.prepare(some, execution.workers());
    for (const int v : some) result[v] = exposure(v);
  }
  return result;
}

// The vertex that is farthest from the mean of all: a tip, whatever their numbers.
int outermost(const Surface& surface) {
  const auto& points = surface.polygons.vertices;
  std::array<double, 3> mean{};
  for (const auto& point : points) {
    for (int i = 0; i < 3; ++i) mean[i] += point[i] / static_cast<double>(points.size());
  }
  const auto distance = [&](const std::array<double, 3>& p) {
    return std::hypot(p[0] - mean[0], p[1] - mean[1], p[2] - mean[2]);
  };
  return static_cast<int>(std::ranges::max_element(points, {}, distance) - points.begin());
}

// The vertex with the longest way to the border.
int farthest(const BorderPaths& paths) {
  const auto distance = [](double d) { return std::isfinite(d) ? d : 0.0; };
  return static_cast<int>(std::ranges::max_element(paths.distances, {}, distance) - paths.distances.begin());
}

}  // namespace

HiddenCut hidden_cut(const Surface& surface, const std::optional<std::array<double, 3>>& up, Execution& execution) {
  const std::vector<double> exposure = exposures(surface, up, execution);
  const auto edge_exposure = [&](std::size_t e) {
    return (exposure[surface.edges[e][0]] + exposure[surface.edges[e][1]]) / 2;
  };
  std::vector<double> times(surface.edges.size());
  for (std::size_t e = 0; e < times.size(); ++e) times[e] = kUnseen + edge_exposure(e);
  HiddenCut result{std::vector<char>(surface.edges.size(), 0)};
  std::vector<char> is_tip(surface.vertex_count, 0), is_joined(surface.vertex_count, 0);
  const int first = outermost(surface);
  is_tip[first] = is_joined[first] = 1;
  for (int count = 1; count < kTips; ++count) {
    const int tip = farthest(border_paths(surface, is_tip, {}, execution));
    is_tip[tip] = 1;
    border_paths(surface, is_joined, times, execution).mark(surface, tip, result.is_cut);
    for (std::size_t e = 0; e < times.size(); ++e) {
      if (result.is_cut[e]) is_joined[surface.edges[e][0]] = is_joined[surface.edges[e][1]] = 1;
    }
  }
  for (std::size_t e = 0; e < times.size(); ++e) {
    if (result.is_cut[e]) result.seen += surface.edge_lengths[e] * edge_exposure(e);
  }
  result.seen /= std::sqrt(area(surface, execution.workers()));
  return result;
}

}  // namespace holomorph::mesh
