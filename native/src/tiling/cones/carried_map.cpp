#include "tiling/cones/carried_map.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "base/errors.h"
#include "mesh/triangle_geometry.h"
#include "progressive/edge_collapse.h"
#include "progressive/refinement.h"

namespace holomorph::tiling {
namespace {

using mesh::Point;
using progressive::CornerTable;
using progressive::Split;

constexpr int kSplitsAtOnce = 4096;  // between two looks at whether the work is cancelled
constexpr int kHalvings = 16;        // of the way of a new vertex from the one that it leaves

double cross(Complex a, Complex b) { return (std::conj(a) * b).imag(); }

// The point of a triangle at 0, e1 and e2 that is nearest to d, or of its plane: parts of e1 and e2.
struct Nearest {
  double first, last, distance;  // the distance is squared
};

Nearest nearest(const Point& e1, const Point& e2, const Point& d, bool is_in_plane) {
  using mesh::dot;
  const double g11 = dot(e1, e1), g12 = dot(e1, e2), g22 = dot(e2, e2), r1 = dot(e1, d), r2 = dot(e2, d);
  const auto at = [&](double a, double b) -> Nearest {
    return {a, b, a * (a * g11 + 2 * b * g12 - 2 * r1) + b * (b * g22 - 2 * r2)};  // less |d|^2
  };
  const double determinant = g11 * g22 - g12 * g12;
  if (determinant > 0) {
    const double a = (g22 * r1 - g12 * r2) / determinant, b = (g11 * r2 - g12 * r1) / determinant;
    if (is_in_plane || (a >= 0 && b >= 0 && a + b <= 1)) return at(a, b);
  }
  const auto part = [](double way, double whole) { return whole > 0 ? std::clamp(way / whole, 0.0, 1.0) : 0.0; };
  const double c = part(r2 - g12 - r1 + g11, g11 - 2 * g12 + g22);
  return std::min({at(part(r1, g11), 0), at(0, part(r2, g22)), at(1 - c, c)},
                  [](const Nearest& x, const Nearest& y) { return x.distance < y.distance; });
}

class Carrier {
 public:
  Carrier(const progressive::ProgressiveMesh& mesh, int splits, const TurnLattice& lattice, const LatticeMap& map)
      : mesh_(mesh), lattice_(lattice), refinement_(mesh, static_cast<int>(mesh.splits.size())), y_(map.y) {
    while (refinement_.splits_made() < splits) refinement_.split();
    for (int r = 0; r < lattice.k; ++r) turned_.push_back(lattice.at(lattice.power(r)(0, 0), lattice.power(r)(1, 0)));
    y_.reserve(static_cast<std::size_t>(mesh.vertex_count()));
    at_.reserve(4 * static_cast<std::size_t>(mesh.triangle_count()));
    at_.resize(4 * map.at.size() / 3);
    for (std::size_t side = 0; side < map.at.size(); ++side) at_[table_side(side)] = map.at[side];
    for (const auto& [v, cone] : map.cones) cones_[v] = {static_cast<int>(table_side(cone.side)), cone.closing};
    is_cone_.assign(static_cast<std::size_t>(mesh.vertex_count()), 0);
    for (const auto& [v, cone] : cones_) is_cone_[v] = 1;
  }

  int splits_left() const { return static_cast<int>(mesh_.splits.size()) - refinement_.splits_made(); }

  void split() {
    refinement_.split();
    const Split& split = mesh_.splits[refinement_.splits_made() - 1];
    n_ = static_cast<int>(refinement_.star_sides().size());
    const auto [from, to, left, right] = refinement_.last();
    // The triangles that the new ones continue, one beyond each end of the sector that moved; of none that moved, the
    // one at the boundary.
    const bool is_empty = from == to;
    const int last = is_empty ? star(split.v_r < 0 ? 0 : n_ - 1) : star(to - 1), first = is_empty ? last : star(from);
    LatticeMap::Cone* const cone = is_cone_[split.v_s] ? &cones_.at(split.v_s) : nullptr;
    if (cone) close_outside(*cone, from, to);
    const int at_l = is_empty ? CornerTable::next(last) : CornerTable::previous(last);
    const int at_r = is_empty ? CornerTable::previous(first) : CornerTable::next(first);
    at_.resize(at_.size() + 4 * static_cast<std::size_t>((left >= 0) + (right >= 0)));
    if (left >= 0) add(left, at_[last], at_[at_l]);
    if (right >= 0) add(right, at_[first], at_[at_r]);
    if (cone && cone->side == first) cone->side = CornerTable::next(right);
    if (left >= 0 && is_cone_[split.v_l]) {
      LatticeMap::Cone& beside = cones_.at(split.v_l);
      if (beside.side == at_l) beside.side = CornerTable::previous(left);
    }
    y_.push_back(place(split));
  }

  // The map of the surface, whose vertices and triangles are those of the progressive mesh in another order.
  LatticeMap map(const mesh::Surface& surface, const Levels& levels) const {
    LatticeMap result{
        std::vector<Complex>(surface.vertex_count, 0.0), std::vector<Symmetry>(3 * surface.triangles.size()), {}};
    for (std::size_t v = 0; v < y_.size(); ++v) result.y[levels.vertex()[v]] = y_[v];
    std::map<int, LatticeMap::Cone> of_side;
    for (const auto& [v, cone] : cones_) of_side[cone.side] = cone;
    const std::vector<mesh::Triple> triangles = refinement_.triangles();
    for (std::size_t side = 0; side < 3 * triangles.size(); ++side) {
      const int v = levels.vertex()[triangles[side / 3][side % 3]], t = levels.triangle()[side / 3];
      const auto corner = std::ranges::find(surface.triangles[t], v) - surface.triangles[t].begin();
      if (corner == 3) throw SolverError("a level has other triangles than its surface");
      const int own = 3 * t + static_cast<int>(corner);
      result.at[own] = at_[table_side(side)];
      const auto cone = of_side.find(static_cast<int>(table_side(side)));
      if (cone != of_side.end()) result.cones[v] = {own, cone->second.closing};
    }
    return result;
  }

 private:
  static std::size_t table_side(std::size_t side) { return side / 3 * 4 + side % 3; }

  int star(int i) const { return refinement_.star_sides()[i % n_]; }
  Complex moved(const Symmetry& by, Complex z) const {
    return turned_[by.turn] * z + lattice_.at(by.translation[0], by.translation[1]);
  }
  // A value at a corner as it is seen from the vertex of another corner of the triangle.
  Complex seen(int from, int corner, int v) const {
    const Symmetry& own = at_[from];
    return std::conj(turned_[own.turn]) *
           (moved(at_[corner], y_[v]) - lattice_.at(own.translation[0], own.translation[1]));
  }

  // What closes around the cone that a split leaves comes after the sector that it moves.
  void close_outside(LatticeMap::Cone& cone, int from, int to) {
    int first = 0;
    while (star(first) != cone.side) ++first;
    while (first < from) first += n_;
    if (first == from || first >= to) return;
    for (int i = first; i < to; ++i) at_[star(i)] = after(lattice_, at_[star(i)], cone.closing);
    cone.side = star(to);
  }

  // The symmetries of a new triangle: one at both ends of the side from the old vertex to the new one.
  void add(int side, const Symmetry& at_ends, const Symmetry& at_apex) {
    at_[side] = at_[CornerTable::next(side)] = at_ends;
    at_[CornerTable::previous(side)] = at_apex;
  }

  // Where the new vertex of the last split is, as the sector that moved sees it.
  Complex place(const Split& split) const;

  const progressive::ProgressiveMesh& mesh_;
  const TurnLattice& lattice_;
  progressive::Refinement refinement_;
  std::vector<Complex> turned_;  // by each number of turns
  std::vector<Complex> y_;       // #V of the level so far
  std::vector<Symmetry> at_;     // sides of a CornerTable
  std::map<int, LatticeMap::Cone> cones_;
  std::vector<char> is_cone_;  // #V
  int n_ = 0;                  // triangles of the star
};

Complex Carrier::place(const Split& split) const {
  const int t = refinement_.splits_made() + mesh_.base_vertex_count() - 1;
  const auto [from, to, left, right] = refinement_.last();
  const std::vector<int>& ends = refinement_.star_vertices();
  const auto end = [&](int i) { return ends[i % std::ssize(ends)]; };
  const Complex y = y_[split.v_s];
  const Point& origin = mesh_.positions[split.v_s];
  const auto to_point = [&](int v) { return mesh::difference(mesh_.positions[v], origin); };
  // The ends of a triangle of the star.
  const auto head = [&](int i) { return seen(star(i), CornerTable::next(star(i)), end(i)); };
  const auto apex = [&](int i) { return seen(star(i), CornerTable::previous(star(i)), end(i + 1)); };

  // At the boundary a vertex may come to lie outside. The star of a cone is not seen as a whole.
  const bool is_open = split.v_l < 0 || split.v_r < 0, is_cone = is_cone_[split.v_s];
  const int only = split.v_l < 0 ? n_ - 1 : 0;
  const Point way = to_point(t);
  double least = kInfinity;
  Complex best = y;
  for (int i = is_open ? only : is_cone ? from : 0; i < (is_open ? only + 1 : is_cone ? to : n_); ++i) {
    const Nearest found = nearest(to_point(end(i)), to_point(end(i + 1)), way, is_open);
    if (!(found.distance < least)) continue;
    least = found.distance;
    best = y + found.first * (head(i) - y) + found.last * (apex(i) - y);
  }

  // Where the triangles at the new vertex are not flipped.
  std::vector<std::pair<Complex, Complex>> opposite;  // the sides of these that do not meet it
  double angle = 0;
  for (int i = from; i < to; ++i) {
    opposite.emplace_back(head(i), apex(i));
    angle += std::arg((opposite.back().second - y) * std::conj(opposite.back().first - y));
  }
  const int beside = from == to ? only : -1;
  const Complex at_l = left < 0 ? y : beside < 0 ? opposite.back().second : head(beside);
  const Complex at_r = right < 0 ? y : beside < 0 ? opposite.front().first : apex(beside);
  if (left >= 0) opposite.emplace_back(at_l, y);
  if (right >= 0) opposite.emplace_back(y, at_r);
  const auto flipped = [&](Complex at) {
    return std::ranges::count_if(opposite,
                                 [&](const auto& side) { return !(cross(side.first - at, side.second - at) > 0); });
  };
  auto fewest = flipped(best);
  if (fewest == 0) return best;
  Complex direction, start = y;
  if (from == to) {  // beyond the boundary
    const Complex along = left >= 0 ? at_l - y : y - at_r;
    start = left >= 0 ? (y + at_l) / 2.0 : (y + at_r) / 2.0;
    direction = Complex(0, -1) * along / 2.0;
    if (left >= 0) direction = -direction;
  } else if (is_open) {  // along it
    direction = (left < 0 ? opposite[to - from - 1].second : opposite.front().first) - y;
  } else {  // between v_r and v_l
    const double most = std::min(angle, std::numbers::pi), least_angle = std::max(angle - std::numbers::pi, 0.0);
    const double length = std::min(std::abs(at_l - y), std::abs(at_r - y));
    direction = std::polar(length, std::arg(at_r - y) + (least_angle + most) / 2);
  }
  double part = 1;
  for (int i = 0; i < kHalvings && fewest > 0; ++i, part /= 2) {
    const Complex other = start + part * direction;
    const auto count = flipped(other);
    if (count < fewest) fewest = count, best = other;
  }
  return best;
}

}  // namespace

LatticeMap carried_map(const mesh::Surface& surface, const Levels& levels, const CoarseLevel& level,
                       const TurnLattice& lattice, const LatticeMap& map, Execution& execution) {
  Carrier carrier(*levels.mesh(), level.splits, lattice, map);
  const double all = carrier.splits_left();
  for (int left = carrier.splits_left(); left > 0; --left) {
    if (left % kSplitsAtOnce == 0) execution.report(1 - left / all);
    carrier.split();
  }
  return carrier.map(surface, levels);
}

}  // namespace holomorph::tiling
