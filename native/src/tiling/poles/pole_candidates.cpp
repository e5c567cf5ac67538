#include "tiling/poles/pole_candidates.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "base/errors.h"
#include "mesh/stars.h"
#include "structure/structure.h"

namespace holomorph::tiling {
namespace {

constexpr double kBallsApart = 0.06;  // least distance of two poles, in square roots of the area
constexpr int kSpread = 200;          // candidates all over the surface
// Around a pole, candidates come from fixed subsets of all vertices, some {600, 1800, 5400} of them, within these
// radii. So poles near each other, and a pole that moved, have candidates in common, and fewer systems are solved.
constexpr std::pair<int, double> kBalls[] = {{600, 0.15}, {1800, 0.08}, {5400, 0.04}};

std::vector<int> evenly(const std::vector<int>& list, int count) {
  if (static_cast<int>(list.size()) <= count) return list;
  std::vector<int> some;
  for (int i = 0; i < count; ++i) some.push_back(list[static_cast<std::size_t>(i) * list.size() / count]);
  return some;
}

}  // namespace

PoleCandidates::PoleCandidates(const PoleBasis& basis, const PlaceOptions& options) : basis_(basis), options_(options) {
  for (int p = 0; p < static_cast<int>(options.polygons.size()); ++p) {
    for (const int v : options.polygons[p]) polygons_at_[v].push_back(p);
  }
}

std::vector<int> PoleCandidates::first() {
  if (!options_.allowed.empty()) return first_candidates();
  if (!basis_.closed()) return {structure::deepest_vertex(basis_.surface(), basis_.half_edges())};
  std::vector<int> pair = structure::far_apart(basis_.surface(), basis_.half_edges());
  // far_apart() asks only that the stars are apart. Here poles also keep a distance, and are not corners of one large
  // polygon.
  return free_ones({pair[1]}, {pair[0]}).empty() ? first_candidates() : pair;
}

// The first poles where only some vertices are allowed: candidates far from each other.
std::vector<int> PoleCandidates::first_candidates() {
  std::vector<int> poles;
  for (const std::size_t count = basis_.closed() ? 2 : 1; poles.size() < count;) {
    const std::vector<int> candidates = everywhere(poles);
    if (candidates.empty()) {
      throw TopologyError((options_.allowed.empty() ? "the vertices of the mesh" : "the vertices allowed for poles") +
                          std::string(" have no room for ") + std::to_string(count) +
                          " poles: the faces around poles must not touch; subdivide the mesh");
    }
    const auto& distance = distances(poles.empty() ? candidates.front() : poles.front());
    poles.push_back(*std::max_element(candidates.begin(), candidates.end(),
                                      [&](int a, int b) { return distance[a] < distance[b]; }));
  }
  return poles;
}

std::vector<int> PoleCandidates::everywhere(const std::vector<int>& others) { return free_ones(spread(), others); }

std::vector<int> PoleCandidates::for_move(int vertex, const std::vector<int>& others) {
  std::vector<int> all = spread();
  const std::vector<int> around = near(vertex);
  all.insert(all.end(), around.begin(), around.end());
  std::erase(all, vertex);
  return free_ones(std::move(all), others);
}

// A corner of each of some evenly spaced samples, the first that can be a pole.
std::vector<int> PoleCandidates::spread() const {
  const mesh::Surface& surface = basis_.surface();
  std::vector<int> corners;
  for (const int t : evenly(basis_.samples(), kSpread)) {
    for (const int v : surface.triangles[t]) {
      if (!basis_.is_place(v, options_.allowed)) continue;
      corners.push_back(v);
      break;
    }
  }
  return corners;
}

std::vector<int> PoleCandidates::near(int vertex) {
  const auto& distance = distances(vertex);
  const auto count = static_cast<int>(distance.size());
  std::vector<int> all;
  for (const auto& [most, ball] : kBalls) {
    const double radius = ball * std::sqrt(basis_.area());
    const int step = 1 + (count - 1) / most;
    for (int v = 0; v < count; v += step) {
      if (distance[v] < radius && is_allowed(v)) all.push_back(v);
    }
  }
  return all;
}

std::vector<int> PoleCandidates::free_ones(std::vector<int> candidates, const std::vector<int>& others) {
  const auto& surface = basis_.surface();
  const auto& half_edges = basis_.half_edges();
  const double apart = kBallsApart * std::sqrt(basis_.area());
  std::vector<char> taken(surface.vertex_count, 0);
  std::set<int> opposite;  // in the large polygons of the others
  for (const int pole : others) {
    if (const auto found = polygons_at_.find(pole); found != polygons_at_.end()) {
      // Diagonals are flipped away from poles, which two corners of one polygon do not allow.
      for (const int polygon : found->second)
        opposite.insert(options_.polygons[polygon].begin(), options_.polygons[polygon].end());
    }
    for (const int v : mesh::corners_around(surface, half_edges, pole)) taken[v] = 1;
    const auto& distance = distances(pole);
    for (std::size_t v = 0; v < taken.size(); ++v) {
      if (distance[v] < apart) taken[v] = 1;
    }
  }
  std::sort(candidates.begin(), candidates.end());
  candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
  std::erase_if(candidates, [&](int v) {
    return taken[v] || opposite.contains(v) || !mesh::has_free_star(surface, half_edges, v, taken);
  });
  return candidates;
}

const std::vector<double>& PoleCandidates::distances(int vertex) {
  auto& found = distances_[vertex];
  if (found.empty()) found = mesh::graph_distances(basis_.half_edges(), basis_.lengths(), {vertex});
  return found;
}

}  // namespace holomorph::tiling
