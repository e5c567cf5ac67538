#include "turns/turned_tiling.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <sstream>
#include <unordered_map>
#include <utility>

#include "base/errors.h"
#include "base/held.h"
#include "mesh/components.h"
#include "mesh/hard_edges.h"

namespace holomorph::turns {
namespace {

constexpr double kMostLost = 0.5;    // part of the area: nothing is left to look at
constexpr double kHard = 40;         // degrees by which a surface bends at an edge that is to be a line
constexpr double kMostEnds = 0.02;   // of chains, for each of their edges
constexpr double kMostOfNet = 1.75;  // edges for each vertex that they meet: a cube has 1.5, all edges of a mesh 2 or 3
constexpr double kUsualTiles = 400, kTilesPerHandle = 64;  // by default, at least

// How often each vertex is met.
std::unordered_map<int, int> meetings(const std::vector<mesh::Pair>& ends) {
  std::unordered_map<int, int> result;
  for (const auto& [a, b] : ends) ++result[a], ++result[b];
  return result;
}

// Whether these are edges of faces that lie side by side, as all are of a mesh that is shaded flat.
bool is_net(const std::vector<mesh::Pair>& ends) {
  return static_cast<double>(ends.size()) > kMostOfNet * static_cast<double>(meetings(ends).size());
}

// Coordinates of the hexagonal lattice become those of the plane.
void place_hexagons(uv::UvArray& uv) {
  for (Eigen::Index c = 0; c < uv.rows(); ++c) {
    const double v = uv(c, 1);
    uv.row(c) << uv(c, 0) + 0.5 * v, 0.5 * std::numbers::sqrt3 * v;
  }
}

void set_added(const uv::Quality& conformal, TurnedTiling& result) {
  double weight = 0, angles = 0, squares = 0;
  for (std::size_t t = 0; t < conformal.angle.size(); ++t) {
    const bool is_lost = conformal.flipped[t] || !std::isfinite(conformal.angle[t]);
    const double angle = is_lost ? uv::kMostAngle : std::min(conformal.angle[t], uv::kMostAngle);
    const double beltrami = is_lost ? 1 : (conformal.angle[t] - 1) / (conformal.angle[t] + 1);
    weight += conformal.weights[t];
    angles += conformal.weights[t] * angle;
    squares += conformal.weights[t] * beltrami * beltrami;
  }
  result.added_distortion = angles / weight;
  result.beltrami_rms = std::sqrt(squares / weight);
}

}  // namespace

TurnedTiler::TurnedTiler(std::shared_ptr<const mesh::Surface> surface, const TilerOptions& options,
                         Execution& execution)
    : surface_(std::move(surface)),
      options_(options),
      usual_tiles_(std::max(kUsualTiles, kTilesPerHandle * mesh::topological_type(*surface_).genus)) {
  if (surface_->intrinsic()) throw TopologyError("a turned map needs positions: the surface has edge lengths alone");
  if (options_.rows == Rows::kMirror && options_.chosen.empty()) half_.emplace(*surface_, options_.up, execution);
  std::vector<int> lines;
  if (half_) {
    lines = half_->lines();
  } else if (options_.rows == Rows::kWhole || options_.rows == Rows::kFree) {
    lines = found_lines(*surface_, options_.marked);
  }
  const bool are_whole = options_.rows == Rows::kWhole || options_.rows == Rows::kMirror;
  if (lines.empty()) options_.rows = Rows::kNone;
  maps_.emplace(half_ ? half_->surface() : surface_,
                ConeOptions{.k = options_.turns, .along = options_.along, .tiles = usual_tiles_ / (half_ ? 2 : 1)},
                Lines{std::move(lines), are_whole}, options_.chosen);
}

TurnedTiling TurnedTiler::tile(double tiles, double evenness, Execution& execution) {
  TurnedTiling result{held(maps_).turned_map(tiles / (half_ ? 2 : 1), evenness, execution), options_.rows, {}, 1, 0};
  if (half_) result.map = half_->unfolded(result.map, options_.turns);
  if (options_.turns == 6) {
    place_hexagons(result.map.uv);
    place_hexagons(result.map.before);
  }
  Workers& workers = execution.workers();
  result.quality = uv::quality(*surface_, result.map.uv, workers);
  if (options_.along && !options_.along->is_of_u)
    result.quality.direction = uv::direction(*surface_, result.map.uv, options_.up, options_.turns, workers);
  if (evenness > 0) {
    const uv::Quality before = uv::quality(*surface_, result.map.before, workers);
    uv::set_evened_from(result.quality, before, evenness);
    set_added(before, result);
  } else {
    set_added(result.quality, result);
  }
  if (result.quality.lost_part > kMostLost) {
    std::ostringstream message;
    message.precision(4);
    message << "with " << tiles << " tiles that turn ";
    message.precision(3);
    message << 100 * result.quality.lost_part
            << " % of this surface would be flipped or collapse: take more tiles, or turns=1";
    throw TopologyError(message.str());
  }
  return result;
}

std::vector<int> found_lines(const mesh::Surface& surface, const std::vector<mesh::Pair>& marked) {
  const std::vector<double> bends = mesh::bends(surface);
  std::vector<int> hard;
  for (int e = 0; e < std::ssize(bends); ++e) {
    if (bends[e] > mesh::radians(kHard)) hard.push_back(e);
  }
  std::vector<int> edges = long_lines(surface, hard);
  std::vector<mesh::Pair> ends;
  for (const int e : edges) ends.push_back(surface.edges[e]);
  if (!are_whole(ends) || is_net(ends)) edges.clear();
  if (marked.empty() || is_net(marked)) return edges;
  std::set<mesh::Pair> wanted;
  for (const auto& [a, b] : marked) wanted.insert({std::min(a, b), std::max(a, b)});
  std::set<int> found(edges.begin(), edges.end());
  for (int e = 0; e < std::ssize(surface.edges); ++e) {
    if (wanted.contains(surface.edges[e])) found.insert(e);
  }
  return {found.begin(), found.end()};
}

bool are_whole(const std::vector<mesh::Pair>& ends) {
  const auto found = meetings(ends);
  const auto lonely = std::ranges::count_if(found, [](const auto& one) { return one.second == 1; });
  return static_cast<double>(lonely) <= kMostEnds * static_cast<double>(ends.size());
}

}  // namespace holomorph::turns
