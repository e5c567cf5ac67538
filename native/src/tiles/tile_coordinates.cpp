#include "tiles/tile_coordinates.h"

#include <Eigen/LU>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <sstream>
#include <string>

#include "base/errors.h"
#include "base/workers.h"

namespace holomorph::tiles {
namespace {

using Eigen::Vector2d;

constexpr double kWhole = 1e-3;  // of a tile: nearer jumps count as whole tiles, also of UVs in single precision
constexpr double kMostBytes = 1e9, kMostPerVertex = 1e5;
constexpr double kMostThings = 1e8;  // so that indices, also of what is made of them, are far below 2^31

Vector2d whole(const Vector2d& jump) { return jump.array().round(); }
bool is_whole(const Vector2d& jump) { return (jump - whole(jump)).cwiseAbs().maxCoeff() <= kWhole; }

std::string text(const Vector2d& jump) {
  std::ostringstream out;
  out.precision(4);
  out << '(' << jump[0] << ", " << jump[1] << ')';
  return out.str();
}

std::string vertices_of(const mesh::Surface& surface, int edge) {
  const auto& [a, b] = surface.edges[edge];
  return "the edge between the vertices " + std::to_string(a) + " and " + std::to_string(b);
}

[[noreturn]] void refuse(const std::string& what) { throw TopologyError("the map is not a tiling: " + what); }

class Making {
 public:
  Making(const mesh::Surface& surface, const Eigen::Ref<const Corners>& uv, const TileFrame& frame)
      : surface_(surface), frame_(frame), group_(mesh::TurnGroup::of_lattice(frame.turns)), lattice_(uv.rows(), 2) {
    for (Eigen::Index c = 0; c < uv.rows(); ++c) lattice_.row(c) = frame.inverse_lattice * uv.row(c).transpose();
    if (!lattice_.allFinite()) refuse("a UV is not finite");
    const Eigen::RowVector2d sum = frame.steps.cwiseAbs().cast<double>().rowwise().sum().transpose();
    const double largest = (lattice_.cwiseAbs().maxCoeff() + frame.origin.cwiseAbs().maxCoeff()) * sum.maxCoeff();
    // Then about as many bits are left for parts of a tile as for whole tiles.
    if (!(largest < std::sqrt(kLargestCoordinate))) refuse("its UVs are " + std::to_string(largest) + " tiles apart");
    result_.unit = kLargestCoordinate / std::exp2(std::ceil(std::log2(largest + 2)));
    result_.group = group_;
    result_.turns = mesh::CornerTurns(surface, lattice_, group_);
    if (group_.order() > 1) shift_ = (2 * steps() * frame.origin).array().round() / 2;
    assert(steps() * group_.power(1) == group_.power(1) * steps());
  }

  TileCoordinates run(Workers& workers) {
    find_bases();
    const int count = static_cast<int>(surface_.triangles.size());
    result_.points.resize(count);
    for_rows(workers, count, [&](int t) {
      for (int i = 0; i < 3; ++i) result_.points[t][i] = point(t, i);
    });
    check_edges();
    double area = 0;
    for (int t = 0; t < count; ++t) area += signed_area(result_, t);
    result_.is_mirrored = area < 0;
    return std::move(result_);
  }

 private:
  Vector2d at(int corner) const { return lattice_.row(corner); }
  Eigen::Matrix2d steps() const { return frame_.steps.cast<double>(); }
  const Eigen::Matrix2d& turn(int t, int i) const { return group_.power(result_.turns.at_corner(3 * t + i)); }
  // From the base corner to corner i of triangle t: x' = R x + jump.
  Vector2d jump(int t, int i) const {
    return at(surface_.triangle_corners[t][i]) - turn(t, i) * at(base_[surface_.triangles[t][i]]);
  }

  Vector2d rounded(int corner) const {
    const Vector2d x = steps() * (at(corner) - frame_.origin) * result_.unit;
    return {std::round(x[0]), std::round(x[1])};
  }

  // A cone is the point that the turn around it leaves. That is half of whole tiles: exact.
  void move_to_centre(int v) {
    const Eigen::Matrix2d others = Eigen::Matrix2d::Identity() - group_.power(result_.turns.around(v));
    const Vector2d tiles = others * at(base_[v]);
    if (is_whole(tiles))
      lattice_.row(base_[v]) = others.inverse() * whole(tiles);
    else
      result_.is_pole[v] = 1;
  }

  // Finds the first corner at each vertex, and the vertices around which jumps are not whole tiles: the poles.
  void find_bases() {
    base_.assign(surface_.vertex_count, kNone);
    result_.is_pole.assign(surface_.vertex_count, 0);
    for (int t = 0; t < static_cast<int>(surface_.triangles.size()); ++t) {
      for (int i = 0; i < 3; ++i) {
        const int v = surface_.triangles[t][i];
        if (base_[v] == kNone) {
          base_[v] = surface_.triangle_corners[t][i];
          if (result_.turns.around(v) != 0) move_to_centre(v);
        }
        if (!is_whole(jump(t, i))) result_.is_pole[v] = 1;
      }
    }
    for (int e = 0; e < static_cast<int>(surface_.edges.size()); ++e) {
      const auto& [a, b] = surface_.edges[e];
      const bool is_border = surface_.edge_face_count[e] == 1;
      // Stars of poles are apart from each other and from the boundary. Elsewhere a jump by parts of a tile is an
      // error.
      if (result_.is_pole[a] + result_.is_pole[b] > (is_border ? 0 : 1))
        refuse("its UVs jump by a fraction of a tile at " + vertices_of(surface_, e));
    }
  }

  Point point(int t, int i) const {
    const int v = surface_.triangles[t][i];
    Vector2d at = rounded(surface_.triangle_corners[t][i]);
    if (!result_.is_pole[v]) {
      // Only one corner at a vertex is rounded. The others are this one, turned and moved by whole tiles: exact
      // integers, so that both sides of a seam agree to the last bit. Turns are about the lattice's origin.
      const bool is_cone = result_.turns.around(v) != 0;
      const Vector2d base = is_cone ? (steps() * this->at(base_[v]) - shift_) * result_.unit : rounded(base_[v]);
      at = turn(t, i) * base + (steps() * whole(jump(t, i)) + turn(t, i) * shift_ - shift_) * result_.unit;
    }
    return {at[0], at[1]};
  }

  // The translation across side i of triangle t to side j of another triangle there, by its start, and by its end.
  std::array<Vector2d, 2> translations(int t, int i, int other, int j) const {
    const int across = result_.turns.across(3 * t + i);
    const auto of = [&](int here, int there) {
      const Vector2d base = at(base_[surface_.triangles[t][here]]);
      const Eigen::Matrix2d turned = group_.power(across) * turn(t, here);
      const Vector2d translation = whole(jump(other, there)) - group_.power(across) * whole(jump(t, here));
      return turned == turn(other, there) ? translation : Vector2d(translation + (turn(other, there) - turned) * base);
    };
    return {of(i, (j + 1) % 3), of((i + 1) % 3, j)};
  }

  // The jump across an edge must be the same at both ends.
  void check_edges() const {
    std::vector<int> first(surface_.edges.size(), kNone);
    for (int t = 0; t < static_cast<int>(surface_.triangles.size()); ++t) {
      const auto& v = surface_.triangles[t];
      for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, e = surface_.triangle_edges[t][i];
        if (result_.is_pole[v[i]] || result_.is_pole[v[j]]) continue;
        if (first[e] != kNone) {
          const auto [start, end] = translations(first[e] / 3, first[e] % 3, t, i);
          if (start != end)
            refuse("its UVs jump by different numbers of tiles at the two ends of " + vertices_of(surface_, e) +
                   ", which differ by " + text(v[j] < v[i] ? Vector2d(end - start) : Vector2d(start - end)));
        }
        first[e] = 3 * t + i;
      }
    }
  }

  const mesh::Surface& surface_;
  const TileFrame& frame_;
  const mesh::TurnGroup group_;
  Corners lattice_;                    // #C x 2; base corners of cones lie at centres of turns
  Vector2d shift_ = Vector2d::Zero();  // N origin
  std::vector<int> base_;              // #V
  TileCoordinates result_;
};

}  // namespace

TileCoordinates tile_coordinates(const mesh::Surface& surface, const Eigen::Ref<const Corners>& uv,
                                 const TileFrame& frame, Execution& execution) {
  return Making(surface, uv, frame).run(execution.workers());
}

void refuse_too_many(const mesh::Surface& surface, double count, double bytes, const std::string& things) {
  const double most = std::max(kMostBytes, kMostPerVertex * surface.vertex_count) / bytes;
  if (count < std::min(most, kMostThings)) return;
  throw SolverError("the surface has " + std::to_string(std::llround(count)) + " " + things + ": too many");
}

}  // namespace holomorph::tiles
