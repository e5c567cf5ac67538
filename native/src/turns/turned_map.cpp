#include "turns/turned_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/errors.h"
#include "evening/evening.h"
#include "tiling/greens/coarse_level.h"
#include "turns/rounding.h"

namespace holomorph::turns {
namespace {

using Eigen::VectorXcd;

constexpr int kFewTriangles = 4000, kMoreTriangles = 20'000;  // of the levels on which cones are searched for
constexpr int kTries = 4;                                     // of the nearest whole numbers
constexpr int kMantissa = 23;                                 // of single precision, less the sign

// Cones on a surface, from those of a level of it: #V.
std::vector<int> carried(const mesh::Surface& surface, const tiling::CoarseLevel& level, const Cones& cones) {
  const Net net(surface);
  std::vector<int> missing(surface.vertex_count, 0);
  for (std::size_t v = 0; v < cones.missing.size(); ++v) {
    if (cones.missing[v] != 0) missing[place_of(net, level.vertex[v])] += cones.missing[v];
  }
  return missing;
}

// The cones: those of least cost of many starts on few triangles, then a short search on more.
std::vector<int> cones_of(const std::shared_ptr<const mesh::Surface>& surface, const ConeOptions& wanted,
                          Execution& execution) {
  if (surface->intrinsic()) throw TopologyError("a turned map needs positions: the surface has edge lengths alone");
  execution.stage("cones", 0, 0.8);
  const Execution::Within within(execution);
  execution.stage("cones", 0, 1);
  const tiling::CoarseLevel fine = tiling::coarse_level(surface, execution, kMoreTriangles);
  const tiling::CoarseLevel coarse = tiling::coarse_level(fine.surface, execution, kFewTriangles);
  const Cones found = find_cones(*coarse.surface, wanted, execution);
  return carried(*surface, fine,
                 refined_cones(*fine.surface, carried(*fine.surface, coarse, found), wanted, execution));
}

// The UVs of polygons' corners in coordinates of the lattice, exact on a grid of powers of two: turns of the lattice
// are integer matrices there, and translations whole.
uv::UvArray corner_uv(const mesh::Surface& surface, const Net& net, const TurnedSpace& space, const VectorXcd& y,
                      const lattice::IntegerVector& z) {
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
  write(std::exp2(std::ceil(std::log2(std::max(most, 1.0))) - kMantissa));
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

double flipped_area(const mesh::Surface& surface, const Net& net, const uv::UvArray& uv) {
  double sum = 0;
  for (int t = 0; t < net.triangle_count(); ++t) {
    const auto& corners = surface.triangle_corners[t];
    const Eigen::RowVector2d first = uv.row(corners[1]) - uv.row(corners[0]),
                             last = uv.row(corners[2]) - uv.row(corners[0]);
    if (!(first[0] * last[1] - first[1] * last[0] > 0)) sum += net.area[t];
  }
  return sum;
}

std::vector<Jump> jumps_of(const mesh::Surface& surface, const Net& net, const Frames& frames, const TurnedSpace& space,
                           const lattice::IntegerVector& z) {
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

PlacedCones::PlacedCones(std::shared_ptr<const mesh::Surface> surface, const ConeOptions& options, Execution& execution)
    : surface_(std::move(surface)),
      net_(*surface_),
      missing_(cones_of(surface_, options, execution)),
      frames_(make_frames(*surface_, net_, options.k, missing_)),
      space_(make_space(net_, frames_, options.k, missing_)),
      nearest_(net_, frames_, space_) {
  level_ =
      options.along ? level_factor(net_, frames_, options.k, surface_->polygons.vertices, *options.along) : Complex(1);
  execution.finish();
}

std::vector<int> PlacedCones::cones() const {
  std::vector<int> result;
  for (int v = 0; v < surface_->vertex_count; ++v) {
    if (missing_[v] != 0 && net_.hole[v] < 0) result.push_back(v);
  }
  return result;
}

std::vector<int> PlacedCones::missing() const {
  std::vector<int> result;
  for (const int v : cones()) result.push_back(missing_[v]);
  return result;
}

VectorXcd PlacedCones::evened(const NearestMap::Rounded& rounded, double evenness, Execution& execution) const {
  VectorXcd y = nearest_.functions(rounded);
  if (evenness == 0) return y;
  evening::Kept kept;
  for (int v = 0; v < surface_->vertex_count; ++v) {
    if (space_.is_fixed[v]) kept.u.push_back(v);
  }
  kept.v = kept.u;
  kept.turns.resize(surface_->triangles.size());
  for (int side = 0; side < net_.side_count(); ++side)
    kept.turns[side / 3][side % 3] = turned_by(space_.lattice, space_.corner_turn[side]);
  const uv::UvArray uv = in_plane(space_.lattice, corner_uv(*surface_, net_, space_, y, rounded.z));
  const uv::UvArray delta = evening::evened(*surface_, uv, kept, evenness, execution);
  for (int v = 0; v < surface_->vertex_count; ++v) y[v] += Complex(delta(v, 0), delta(v, 1));
  return y;
}

TurnedMap PlacedCones::turned_map(double tiles, double evenness, Execution& execution) const {
  execution.stage("rounding", 0, 0.2);
  execution.report(0);
  const double size = std::sqrt(tiles / net_.whole_area / space_.lattice.second.imag());
  const std::vector<NearestMap::Rounded> nearest = nearest_.round(size * level_);
  // The nearest whole numbers with which no triangle is flipped, or the fewest: they pin cones to centres of turns.
  TurnedMap result;
  double least = std::numeric_limits<double>::infinity();
  const int tries = std::min<int>(kTries, static_cast<int>(nearest.size()));
  for (int i = 0; i < tries && least > 0; ++i) {
    execution.stage("evening", 0.2 + 0.8 * i / tries, 0.2 + 0.8 * (i + 1) / tries);
    const VectorXcd y = evened(nearest[i], evenness, execution);
    uv::UvArray uv = corner_uv(*surface_, net_, space_, y, nearest[i].z);
    const double flipped = flipped_area(*surface_, net_, uv);
    if (flipped < least) {
      least = flipped;
      result = {std::move(uv), jumps_of(*surface_, net_, frames_, space_, nearest[i].z)};
    }
  }
  execution.finish();
  return result;
}

}  // namespace holomorph::turns
