#include "tiling/cones/turned_tiling.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <sstream>
#include <unordered_map>
#include <utility>

#include "base/constants.h"
#include "base/errors.h"
#include "mesh/components.h"
#include "mesh/hard_edges.h"
#include "mesh/make_surface.h"

namespace holomorph::tiling {
namespace {

constexpr std::array<Complex, 4> kQuarters{Complex(1, 0), Complex(0, 1), Complex(-1, 0), Complex(0, -1)};

mesh::Mirror mirror_of(const mesh::Surface& surface, uv::Up up) {
  auto found = mesh::mirror(surface, static_cast<int>(up));
  if (!found) throw TopologyError("lines is \"mirror\", and this surface does not mirror itself in a vertical plane");
  return *std::move(found);
}

Complex at(const uv::UvArray& uv, int corner) { return {uv(corner, 0), uv(corner, 1)}; }

constexpr double kMostLost = 0.5;    // part of the area: nothing is left to look at
constexpr double kHardDegrees = 40;  // degrees by which a surface bends at an edge that is to be a line
constexpr double kMostEnds = 0.02;   // of chains, for each of their edges
constexpr double kMostOfNet = 1.75;  // edges for each vertex that they meet: a cube has 1.5, all edges of a mesh 2 or 3
constexpr double kUsualTiles = 400, kTurnedTilesPerHandle = 64;  // by default, at least

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

// Finds the jumps of a map in coordinates of the square lattice, by edges. @param uv #C x 2
std::vector<Jump> jumps_in_plane(const mesh::Surface& surface, const uv::UvArray& uv, int turns) {
  // The UVs at the lower and the higher end of an edge, in the triangle on its left and in that on its right: the left
  // one runs along it, from the lower vertex on.
  struct Sides {
    std::array<Complex, 2> low, high;
    std::array<bool, 2> is_there{};
  };
  std::vector<Sides> sides(surface.edges.size());
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const int next = (i + 1) % 3;
      const bool is_left = surface.triangles[t][i] < surface.triangles[t][next];
      const Complex start = at(uv, surface.triangle_corners[t][i]), end = at(uv, surface.triangle_corners[t][next]);
      Sides& own = sides[surface.triangle_edges[t][i]];
      own.low[is_left ? 0 : 1] = is_left ? start : end;
      own.high[is_left ? 0 : 1] = is_left ? end : start;
      own.is_there[is_left ? 0 : 1] = true;
    }
  }
  std::vector<Jump> result;
  for (int e = 0; e < std::ssize(sides); ++e) {
    const auto& [low, high, is_there] = sides[e];
    if (!is_there[0] || !is_there[1]) continue;
    const double angle = std::arg((high[1] - low[1]) * std::conj(high[0] - low[0]));
    const int turn = static_cast<int>(std::nearbyint(angle * turns / kTwoPi));
    Jump jump{e, (turn % turns + turns) % turns, {}};
    const Complex by = low[1] - kQuarters[jump.turn * 4 / turns] * low[0];
    jump.translation = {std::llrint(by.real()), std::llrint(by.imag())};
    if (jump.turn != 0 || jump.translation[0] != 0 || jump.translation[1] != 0) result.push_back(jump);
  }
  return result;
}

}  // namespace

Half::Half(const mesh::Surface& whole, uv::Up up, Execution& execution) : whole_(whole), mirror_(mirror_of(whole, up)) {
  mesh::PolygonParts parts(whole.polygons);
  std::vector<int> faces;
  for (int f = 0; f < std::ssize(mirror_.half); ++f) {
    if (mirror_.half[f]) faces.push_back(f);
  }
  mesh::PolygonPart part = parts.take(std::move(faces));
  corners_ = std::move(part.corner_index);
  vertices_ = std::move(part.vertex_index);
  auto made = std::make_shared<mesh::Surface>(mesh::make_surface(std::move(part.polygons), execution));
  if (made->component_count > 1) throw TopologyError("lines is \"mirror\", and half of this surface falls apart");
  for (int e = 0; e < std::ssize(made->edges); ++e) {
    const auto [a, b] = made->edges[e];
    if (mirror_.on_plane[vertices_[a]] && mirror_.on_plane[vertices_[b]]) lines_.push_back(e);
  }
  surface_ = std::move(made);
}

TurnedMap Half::unfolded(const TurnedMap& of_half, int turns) const {
  TurnedMap result;
  result.uv = unfolded(of_half.uv);
  result.before = of_half.before;
  for (const int cone : of_half.cones) result.cones.push_back(vertices_[cone]);
  for (std::size_t k = 0; k < of_half.cones.size(); ++k) result.cones.push_back(mirror_.vertices[result.cones[k]]);
  result.missing = of_half.missing;
  result.missing.insert(result.missing.end(), of_half.missing.begin(), of_half.missing.end());
  add_cones_in_plane(turns, result);
  result.jumps = jumps_in_plane(whole_, result.uv, turns);
  return result;
}

uv::UvArray Half::unfolded(const uv::UvArray& uv) const {
  uv::UvArray result(static_cast<Eigen::Index>(mirror_.corners.size()), 2);
  for (std::size_t c = 0; c < corners_.size(); ++c) {
    const auto own = uv.row(static_cast<Eigen::Index>(c));
    result.row(corners_[c]) = own;
    result.row(mirror_.corners[corners_[c]]) << -own[0], own[1];
  }
  return result;
}

void Half::add_cones_in_plane(int turns, TurnedMap& map) const {
  std::vector<double> around(whole_.vertex_count, 0.0);  // in full turns
  std::vector<char> is_inner(whole_.vertex_count, 1);
  for (std::size_t t = 0; t < whole_.triangles.size(); ++t) {
    std::array<Complex, 3> z;
    for (int i = 0; i < 3; ++i) z[i] = at(map.uv, whole_.triangle_corners[t][i]);
    for (int i = 0; i < 3; ++i) {
      const double angle = std::arg((z[(i + 2) % 3] - z[i]) * std::conj(z[(i + 1) % 3] - z[i]));
      around[whole_.triangles[t][i]] += angle / kTwoPi;
    }
  }
  for (std::size_t e = 0; e < whole_.edges.size(); ++e) {
    if (whole_.edge_face_count[e] == 1) is_inner[whole_.edges[e][0]] = is_inner[whole_.edges[e][1]] = 0;
  }
  for (int v = 0; v < whole_.vertex_count; ++v) {
    const int lacking = static_cast<int>(std::nearbyint((1 - around[v]) * turns));
    if (!mirror_.on_plane[v] || !is_inner[v] || lacking == 0) continue;
    map.cones.push_back(v);
    map.missing.push_back(lacking);
  }
}

TurnedTiler::TurnedTiler(std::shared_ptr<const mesh::Surface> surface, const TilerOptions& options,
                         Execution& execution)
    : surface_(std::move(surface)),
      options_(options),
      usual_tiles_(std::max(kUsualTiles, kTurnedTilesPerHandle * mesh::topological_type(*surface_).genus)) {
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
                Lines{std::move(lines), are_whole}, options_.chosen, half_ ? nullptr : options_.levels);
}

TurnedTiling TurnedTiler::tile(double tiles, double evenness, Execution& execution) {
  TurnedTiling result{held(maps_).turned_map(tiles / (half_ ? 2 : 1), evenness, execution), options_.rows, {}, 1, 0};
  if (half_) result.map = half_->unfolded(result.map, options_.turns);
  Workers& workers = execution.workers();
  result.quality = uv::quality(*surface_, result.map.uv, workers);
  if (options_.along && !options_.along->is_of_u)
    result.quality.direction = uv::direction(*surface_, result.map.uv, options_.up, options_.turns, workers);
  if (evenness > 0) {
    uv::set_evened_from(result.quality, result.map.before, evenness);
    set_added(result.map.before, result);
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
    if (bends[e] > mesh::radians(kHardDegrees)) hard.push_back(e);
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

}  // namespace holomorph::tiling
