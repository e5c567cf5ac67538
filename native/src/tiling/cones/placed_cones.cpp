#include "tiling/cones/placed_cones.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/constants.h"
#include "tiling/cones/upright.h"
#include "uv/evening.h"

namespace holomorph::tiling {
namespace {

using Eigen::VectorXcd;

constexpr double kLevel = 0.1;  // of what does not stand upright, beside the strain
constexpr double kPull = 3;     // with which frames are turned level, see pull_level
constexpr int kTries = 4;       // of the nearest whole numbers
// Parts of the area that are wrong: then other whole numbers do not help, or cones are not worth being evened.
constexpr double kHopeless = 2e-3, kHopelessCones = 0.1;
// From so many triangles on the first map is taken of which no more than this part of a tile is wrong, or flipped:
// nobody sees it.
constexpr int kManyTriangles = 15'000;
constexpr double kUnseen = 0.08, kUnseenFlipped = 1e-3;
constexpr int kSingleMantissa = 23;  // of single precision, less the sign

// The UVs of polygons' corners in coordinates of the lattice, exact on a grid of powers of two: turns of the lattice
// are integer matrices there, and translations whole.
uv::UvArray corner_uv(const mesh::Surface& surface, const Net& net, const TurnedSpace& space, const VectorXcd& y,
                      const linear::IntegerVector& z) {
  const Eigen::VectorXd whole = space.offset * z.cast<double>();
  const double height = space.lattice.second.imag(), slant = space.lattice.second.real();
  uv::UvArray uv = uv::UvArray::Zero(static_cast<Eigen::Index>(surface.polygons.corner_vertices.size()), 2);
  const auto write = [&](double grid) {
    for (int side = 0; side < net.side_count(); ++side) {
      const Complex at = y[net.tail[side]];
      Eigen::Vector2d own(at.real() - at.imag() * slant / height, at.imag() / height);
      if (grid > 0) own = (own / grid).array().round() * grid;
      const Eigen::Vector2d x =
          space.lattice.power(space.corner_turn[side]).cast<double>() * own + whole.segment<2>(2 * side);
      uv.row(surface.triangle_corners[side / 3][side % 3]) = x.transpose();
    }
  };
  write(0);
  const double most = uv.cwiseAbs().maxCoeff();
  write(std::exp2(std::ceil(std::log2(std::max(most, 1.0))) - kSingleMantissa));
  return uv;
}

// The same in the plane, where turns keep lengths.
uv::UvArray in_plane(const TurnLattice& lattice, const uv::UvArray& coordinates) {
  uv::UvArray result = coordinates;
  if (lattice.k != 6) return result;
  result.col(0) += lattice.second.real() * coordinates.col(1);
  result.col(1) *= lattice.second.imag();
  return result;
}

struct WrongArea {
  double whole = 0;    // of triangles that are flipped, or around vertices at which the map has not the wanted angle:
                       // evening may turn triangles back at a cone by turning a neighbour of it into a branch point
  double flipped = 0;  // of the former
};

WrongArea wrong_area(const mesh::Surface& surface, const Net& net, const uv::UvArray& in_plane, int k,
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
  WrongArea result;
  for (int t = 0; t < net.triangle_count(); ++t) {
    const bool is_wrong = std::ranges::any_of(surface.triangles[t], [&](int v) {
      return !net.on_boundary[v] &&
             std::abs(turned[v] - (1 - static_cast<double>(missing[v]) / k)) > 0.75;  // it is off by whole turns
    });
    if (is_wrong || is_flipped[t]) result.whole += net.area[t];
    if (is_flipped[t]) result.flipped += net.area[t];
  }
  return result;
}

std::vector<Jump> jumps_at(const mesh::Surface& surface, const Net& net, const Frames& frames, const TurnedSpace& space,
                           const linear::IntegerVector& z) {
  std::vector<Jump> jumps;
  for (int side = 0; side < net.side_count(); ++side) {
    const int turn = frames.turn[side];
    // From the triangle on the left of the edge, which it runs along.
    if (turn < 0 || net.tail[side] != surface.edges[net.edge[side]][0]) continue;
    const auto by = space.translation(side, turn, z);
    if (turn != 0 || !by.isZero()) jumps.push_back({net.edge[side], turn, {by[0], by[1]}});
  }
  std::sort(jumps.begin(), jumps.end(), [](const Jump& a, const Jump& b) { return a.edge < b.edge; });
  return jumps;
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

uv::UvArray PlacedCones::coordinates(const VectorXcd& y, const NearestMap::Rounded& rounded) const {
  return corner_uv(*surface_, net_, space_, y, rounded.z);
}

VectorXcd PlacedCones::evened(VectorXcd y, const NearestMap::Rounded& rounded, double evenness,
                              Execution& execution) const {
  if (evenness == 0) return y;
  uv::UvArray uv = in_plane(space_.lattice, coordinates(y, rounded));
  const uv::UvArray delta = uv::evened(*surface_, std::move(uv), kept(), evenness, execution);
  for (int v = 0; v < surface_->vertex_count; ++v) y[v] += Complex(delta(v, 0), delta(v, 1));
  return y;
}

std::vector<NearestMap::Rounded> PlacedCones::nearest(double tiles) const {
  return nearest_.round(std::sqrt(tiles / net_.whole_area));
}

std::pair<double, double> PlacedCones::badness(double tiles, double evenness, Execution& execution) const {
  const NearestMap::Rounded rounded = nearest(tiles)[0];
  VectorXcd y = nearest_.functions(rounded, false);
  const auto laid = [&] { return in_plane(space_.lattice, coordinates(y, rounded)); };
  double wrong = wrong_area(*surface_, net_, laid(), space_.lattice.k, missing_).whole;
  if (wrong <= kHopelessCones * net_.whole_area) {
    wrong = 0;
    y = evened(y, rounded, evenness, execution);
  }
  return {wrong, strain(laid(), evenness, execution)};
}

PlacedCones::Judged PlacedCones::best_map(double tiles, double evenness, const Effort& effort,
                                          Execution& execution) const {
  execution.stage("rounding", 0, 0.2);
  execution.report(0);
  const std::vector<NearestMap::Rounded> nearest = this->nearest(tiles);
  // Whole numbers pin cones to centres of turns.
  Judged best;
  const int tries = std::min<int>(kTries, static_cast<int>(nearest.size()));
  const bool compares = net_.triangle_count() < kManyTriangles;
  const double tile = compares ? 0 : net_.whole_area / tiles;
  const double hopeless = kHopeless * net_.whole_area;
  for (int i = 0; i < tries && (compares || !best.is_last); ++i) {
    if (i > 0 && best.bad.first > hopeless) break;
    execution.stage("evening", 0.2 + 0.8 * i / tries, 0.2 + 0.8 * (i + 1) / tries);
    const VectorXcd y = nearest_.functions(nearest[i], false);  // conformal; evening may begin from a map more level
    const VectorXcd begin = nearest[i].is_level && evenness > 0 ? nearest_.functions(nearest[i], true) : y;
    uv::UvArray uv = coordinates(evened(begin, nearest[i], evenness, execution), nearest[i]);
    const uv::UvArray laid = in_plane(space_.lattice, uv);
    const WrongArea wrong = wrong_area(*surface_, net_, laid, space_.lattice.k, missing_);
    const std::pair<double, double> bad{wrong.whole, strain(laid, evenness, execution)};
    if (bad < best.bad) {
      const std::vector<Jump> jumps = jumps_at(*surface_, net_, frames_, space_, nearest[i].z);
      best = {{std::move(uv), coordinates(y, nearest[i]), jumps, {}, {}}, bad};
      best.is_last = wrong.whole <= kUnseen * tile && wrong.flipped <= kUnseenFlipped * tile;
    }
    if (!effort.goes_on()) {
      best.is_last = true;
      break;
    }
  }
  for (int v = 0; v < surface_->vertex_count; ++v) {
    if (missing_[v] == 0 || net_.on_boundary[v]) continue;
    best.map.cones.push_back(v);
    best.map.missing.push_back(missing_[v]);
  }
  return best;
}

void PlacedCones::turn_upright(TurnedMap& map, const Along& along) const {
  const std::vector<int> s =
      upright_turns(*surface_, net_, in_plane(space_.lattice, map.uv), space_.lattice.k, along, frames_.turn);
  const auto power = [&](int t) { return space_.lattice.power(s[t]); };
  for (uv::UvArray* uv : {&map.uv, &map.before}) {
    const uv::UvArray as_given = *uv;
    for (int t = 0; t < net_.triangle_count(); ++t) {
      for (const int c : surface_->triangle_corners[t])
        uv->row(c) = (power(t).cast<double>() * as_given.row(c).transpose()).transpose();
    }
  }
  std::vector<Jump> own = std::exchange(map.jumps, {});
  for (int side = 0; side < net_.side_count(); ++side) {
    const int back = net_.twin[side], edge = net_.edge[side];
    if (back < 0 || net_.tail[side] != surface_->edges[edge][0]) continue;
    const auto known = std::ranges::lower_bound(own, edge, {}, &Jump::edge);
    const Jump before = known != own.end() && known->edge == edge ? *known : Jump{edge};
    const Eigen::Matrix<std::int64_t, 2, 1> by(before.translation[0], before.translation[1]);
    const Eigen::Matrix<std::int64_t, 2, 1> moved = power(back / 3).cast<std::int64_t>() * by;
    const int k = space_.lattice.k, turn = ((before.turn + s[back / 3] - s[side / 3]) % k + k) % k;
    if (turn != 0 || !moved.isZero()) map.jumps.push_back({edge, turn, {moved[0], moved[1]}});
  }
  std::ranges::sort(map.jumps, {}, &Jump::edge);
}

}  // namespace holomorph::tiling
