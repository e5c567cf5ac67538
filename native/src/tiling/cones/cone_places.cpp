#include "tiling/cones/cone_places.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "tiling/cones/scale_form.h"

namespace holomorph::tiling {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr std::size_t kExtrema = 80;  // at most

}  // namespace

ConePlaces::ConePlaces(const mesh::Surface& surface, const Net& net, std::vector<int> patch)
    : points_(surface.polygons.vertices), net_(net), patch_(std::move(patch)), have_patches_(!patch_.empty()) {
  if (!have_patches_) patch_.assign(net.vertex_count(), 0);
}

bool ConePlaces::is_place(int v) const { return net_.first[v] >= 0 && place_of(net_, v) == v && patch_[v] >= 0; }

double ConePlaces::squared_distance(int v, int w) const {
  double sum = 0;
  for (int i = 0; i < 3; ++i) sum += (points_[v][i] - points_[w][i]) * (points_[v][i] - points_[w][i]);
  return sum;
}

std::vector<int> ConePlaces::spread(const Eigen::VectorXd& function, int count) const {
  std::vector<int> spread;
  std::vector<double> highest(net_.vertex_count(), -kInfinite), lowest(net_.vertex_count(), kInfinite);
  for (int side = 0; side < net_.side_count(); ++side) {
    const double value = function[net_.head[side]];
    highest[net_.tail[side]] = std::max(highest[net_.tail[side]], value);
    lowest[net_.tail[side]] = std::min(lowest[net_.tail[side]], value);
  }
  for (int v = 0; v < net_.vertex_count(); ++v) {
    if (is_place(v) && (function[v] >= highest[v] || function[v] <= lowest[v])) spread.push_back(v);
  }
  std::stable_sort(spread.begin(), spread.end(),
                   [&](int a, int b) { return std::abs(function[a]) > std::abs(function[b]); });
  if (spread.size() > kExtrema) spread.resize(kExtrema);
  for (int v = 0; v < net_.vertex_count(); ++v) {
    if (is_hole(v)) spread.push_back(v);
  }
  std::vector<double> distance(net_.vertex_count(), kInfinite);
  int farthest = -1;
  for (int v = 0; v < net_.vertex_count() && farthest < 0; ++v) {
    if (is_place(v)) farthest = v;
  }
  for (int n = static_cast<int>(kExtrema); n < count && farthest >= 0; ++n) {
    spread.push_back(farthest);
    const int last = farthest;
    farthest = -1;
    for (int v = 0; v < net_.vertex_count(); ++v) {
      distance[v] = std::min(distance[v], squared_distance(v, last));
      if (is_place(v) && distance[v] > 0 && (farthest < 0 || distance[v] > distance[farthest])) farthest = v;
    }
  }
  return spread;
}

std::vector<int> ConePlaces::within(int v, double squared) const {
  std::vector<int> within;
  for (int w = 0; w < net_.vertex_count(); ++w) {
    if (is_place(w) && squared_distance(v, w) < squared) within.push_back(w);
  }
  return within;
}

std::vector<std::vector<std::size_t>> ConePlaces::near(const std::vector<int>& vertices, double squared) const {
  std::vector<std::vector<std::size_t>> near(vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    for (std::size_t j = 0; j < vertices.size(); ++j) {
      if (i != j && !is_hole(vertices[i]) && !is_hole(vertices[j]) &&
          squared_distance(vertices[i], vertices[j]) < squared)
        near[i].push_back(j);
    }
  }
  return near;
}

}  // namespace holomorph::tiling
