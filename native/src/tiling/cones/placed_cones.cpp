#include "tiling/cones/placed_cones.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/constants.h"
#include "tiling/cones/upright.h"

namespace holomorph::tiling {
namespace {

using Eigen::VectorXcd;

constexpr double kLevel = 0.1;  // of what does not stand upright, beside the strain
constexpr double kPull = 3;     // with which frames are turned level, see pull_level
// Part of the area that is wrong: then other whole numbers do not help.
constexpr double kHopeless = 2e-3;
std::array<int, 2> whole_numbers(const Eigen::Vector2d& x) {
  return {static_cast<int>(std::lround(x[0])), static_cast<int>(std::lround(x[1]))};
}

// The area of triangles that are flipped, or around vertices at which the map has not the wanted angle: evening may
// turn triangles back at a cone by turning a neighbour of it into a branch point.
double wrong_area(const mesh::Surface& surface, const Net& net, const uv::UvArray& in_plane, int k,
                  const std::vector<int>& missing) {
  std::vector<double> turned(net.vertex_count(), 0.0);  // full turns
  std::vector<char> is_flipped(net.triangle_count(), 0);
  for (int side = 0; side < net.side_count(); ++side) {
    if (!(net.area[side / 3] > 0)) continue;
    const auto at = [&](int corner) {
      const auto row = in_plane.row(surface.triangle_corners[side / 3][corner % 3]);
      return Complex(row[0], row[1]);
    };
    const int corner = side % 3;
    const Complex to_next = at(corner + 1) - at(corner), to_last = at(corner + 2) - at(corner);
    const Complex ratio = std::conj(to_next) * to_last;
    if (!(ratio.imag() > 0)) is_flipped[side / 3] = 1;
    turned[net.tail[side]] += std::arg(ratio) / kTwoPi;
  }
  double result = 0;
  for (int t = 0; t < net.triangle_count(); ++t) {
    const bool is_wrong = std::ranges::any_of(surface.triangles[t], [&](int v) {
      return !net.on_boundary[v] &&
             std::abs(turned[v] - (1 - static_cast<double>(missing[v]) / k)) > 0.75;  // it is off by whole turns
    });
    if (is_wrong || is_flipped[t]) result += net.area[t];
  }
  return result;
}

}  // namespace

PlacedCones::PlacedCones(std::shared_ptr<const mesh::Surface> surface, const ConeOptions& options,
                         std::vector<int> missing, Execution& execution)
    : surface_(std::move(surface)),
      net_(*surface_),
      missing_(std::move(missing)),
      frames_(levelled(make_frames(*surface_, net_, options.k, missing_), options)),
      space_(make_space(net_, frames_, options.k, missing_, false)),
      nearest_(net_, frames_, space_, true, execution),
      along_(options.along) {}

Frames PlacedCones::levelled(Frames frames, const ConeOptions& options) const {
  if (!options.along) return frames;
  const std::vector<std::array<double, 3>>& points = surface_->polygons.vertices;
  const double turn = std::arg(level_factor(net_, frames, options.k, points, *options.along));
  for (double& angle : frames.angle) angle -= turn;
  frames.level = frames.angle;
  pull_level(net_, points, options.k, *options.along, kPull, frames.level);
  return frames;
}

double PlacedCones::strain(const uv::UvArray& laid, double evenness, Execution& execution) const {
  const double off = along_ ? off_level(*surface_, net_, laid, space_.lattice.k, *along_) : 0;
  return uv::strain(*surface_, laid, kept(), evenness, execution) + kLevel * off;
}

PlacedCones::PlacedCones(std::shared_ptr<const mesh::Surface> surface, const ConeOptions& options, const Lines& lines,
                         Execution& execution)
    : surface_(std::move(surface)),
      net_(*surface_, lines.edges),
      frames_(lined_frames(*surface_, net_, options, missing_, execution)),
      space_(make_space(net_, frames_, options.k, missing_, lines.are_whole)),
      nearest_(net_, frames_, space_, false, execution),
      along_(options.along) {}

uv::Kept PlacedCones::kept() const {
  uv::Kept kept;
  kept.unknowns = space_.unknowns;
  for (int v = 0; v < surface_->vertex_count; ++v) {
    if (space_.unknowns.number[2 * v] < 0) kept.u.push_back(v);
    if (space_.unknowns.number[2 * v + 1] < 0) kept.v.push_back(v);
  }
  kept.turns.resize(surface_->triangles.size());
  for (int side = 0; side < net_.side_count(); ++side)
    kept.turns[side / 3][side % 3] = turned_by(space_.lattice, space_.corner_turn[side]);
  return kept;
}

// A corner has x = R^turn y + whole. By the first corner of its vertex, which is not turned, whole numbers remain.
LatticeMap PlacedCones::map(const VectorXcd& y, const NearestMap::Rounded& rounded) const {
  const Eigen::VectorXd whole = space_.offset * rounded.z.cast<double>();
  const TurnLattice& lattice = space_.lattice;
  LatticeMap result{{y.begin(), y.end()}, std::vector<Symmetry>(net_.side_count()), {}};
  for (int v = 0; v < net_.vertex_count(); ++v) {
    if (const int first = net_.first[v]; first >= 0) result.y[v] += lattice.at(whole[2 * first], whole[2 * first + 1]);
  }
  for (int side = 0; side < net_.side_count(); ++side) {
    const int turn = space_.corner_turn[side];
    const Eigen::Vector2d by = whole.segment<2>(2 * side) -
                               lattice.power(turn).cast<double>() * whole.segment<2>(2 * net_.first[net_.tail[side]]);
    result.at[side] = {turn, whole_numbers(by)};
  }
  for (int v = 0; v < net_.vertex_count(); ++v) {
    if (missing_[v] % lattice.k == 0 || net_.on_boundary[v]) continue;
    // The first triangle follows the last one across this side; the cone stays where it is.
    const int first = net_.first[v], across = net_.twin[first];
    const int turn = (space_.corner_turn[Net::next(across)] + std::max(frames_.turn[across], 0)) % lattice.k;
    const Eigen::Vector2d at = whole.segment<2>(2 * first), by = at - lattice.power(turn).cast<double>() * at;
    result.cones[v] = {first, {turn, whole_numbers(by)}};
  }
  return result;
}

uv::UvArray PlacedCones::laid(const LatticeMap& map) const { return corner_uv(*surface_, space_.lattice, map); }

VectorXcd PlacedCones::evened(VectorXcd y, const NearestMap::Rounded& rounded, double evenness,
                              const uv::EveningOptions& options, Execution& execution) const {
  if (evenness == 0) return y;
  const uv::UvArray delta = uv::evened(*surface_, laid(map(y, rounded)), kept(), evenness, execution, options);
  for (int v = 0; v < surface_->vertex_count; ++v) y[v] += Complex(delta(v, 0), delta(v, 1));
  return y;
}

std::vector<NearestMap::Rounded> PlacedCones::nearest(double tiles) const {
  return nearest_.round(std::sqrt(tiles / net_.whole_area));
}

PlacedCones::Judged PlacedCones::best_map(double tiles, double evenness, int tries, const uv::EveningOptions& options,
                                          Execution& execution) const {
  execution.stage("rounding", 0, 0.2);
  execution.report(0);
  const std::vector<NearestMap::Rounded> nearest = this->nearest(tiles);
  // Whole numbers pin cones to centres of turns.
  Judged best;
  tries = std::min<int>(tries, static_cast<int>(nearest.size()));
  for (int i = 0; i < tries; ++i) {
    if (i > 0 && best.bad.first > kHopeless * net_.whole_area) break;
    execution.stage("evening", 0.2 + 0.8 * i / tries, 0.2 + 0.8 * (i + 1) / tries);
    const VectorXcd y = nearest_.functions(nearest[i], false);  // conformal; evening may begin from a map more level
    const VectorXcd begin = nearest[i].is_level && evenness > 0 ? nearest_.functions(nearest[i], true) : y;
    LatticeMap map = this->map(evened(begin, nearest[i], evenness, options, execution), nearest[i]);
    const uv::UvArray uv = laid(map);
    const std::pair bad(wrong_area(*surface_, net_, uv, space_.lattice.k, missing_), strain(uv, evenness, execution));
    if (bad < best.bad) best = {std::move(map), laid(this->map(y, nearest[i])), bad};
  }
  return best;
}

}  // namespace holomorph::tiling
