#include "flat/island_layout.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <tuple>

#include "base/constants.h"
#include "flat/arrangement.h"
#include "flat/split_overlaps.h"
#include "mesh/hard_edges.h"
#include "uv/appearance.h"
#include "uv/quality.h"
#include "uv/uv_map.h"

namespace holomorph::flat {
namespace {

// Joins flat islands edge to edge into nets that do not overlap.

constexpr int kMostTriangles = 4096;                            // the most in a net: all pairs of two nets are tested
constexpr double kSameLength = 1e-3;                            // difference over the longer side
const double kHeldTurn = std::cos(5 * std::numbers::pi / 180);  // of an island that is held

// z -> turn z + shift
struct Motion {
  Complex turn = 1, shift = 0;
  Complex operator()(Complex z) const { return turn * z + shift; }
};

class Nets {
 public:
  Nets(const mesh::Surface& surface, const uv::UvArray& uv, const std::vector<char>& is_held, Execution& execution)
      : surface_(surface), uv_(uv), is_held_(is_held), execution_(execution) {
    const int count = surface.component_count;
    triangles_.resize(count), islands_.resize(count), motions_.resize(count);
    net_.resize(count);
    std::iota(net_.begin(), net_.end(), 0);
    for (int k = 0; k < count; ++k) islands_[k] = {k};
    corner_islands_.resize(surface.polygons.corner_vertices.size());
    const auto& offsets = surface.polygons.face_offsets;
    for (std::size_t f = 0; f + 1 < offsets.size(); ++f)
      std::fill(corner_islands_.begin() + offsets[f], corner_islands_.begin() + offsets[f + 1],
                surface.face_component[f]);
    for (int t = 0; t < static_cast<int>(surface.triangles.size()); ++t)
      triangles_[island_at(surface.triangle_corners[t][0])].push_back(t);
    sizes_.resize(count);
    for (int k = 0; k < count; ++k) sizes_[k] = static_cast<int>(triangles_[k].size());
  }

  int island_at(int corner) const { return corner_islands_[corner]; }
  int net_of(int island) const { return net_[island]; }
  // Where a corner is after all motions.
  Complex at(int corner) const { return motions_[island_at(corner)](Complex(uv_(corner, 0), uv_(corner, 1))); }

  void report(double done) {
    done_ = done;
    execution_.report(done_);
  }

  void join(Joint joint) {
    int one = net_[island_at(joint[0])], other = net_[island_at(joint[2])];
    if (one == other || sizes_[one] + sizes_[other] > kMostTriangles) return;
    // The larger net stays where it is, or the one that must not be turned.
    const bool swaps = sizes_[one] < sizes_[other];
    for (const bool exchanged : {swaps, !swaps}) {
      if (exchanged ? arrive(other, one, {joint[2], joint[3], joint[0], joint[1]}) : arrive(one, other, joint)) return;
    }
  }

 private:
  // Moves the net `other` to `one`, if that can be done. @return whether no more is to be tried
  bool arrive(int one, int other, const Joint& joint) {
    const std::array<Complex, 2> stays{at(joint[0]), at(joint[1])}, moves{at(joint[2]), at(joint[3])};
    // Each side has its polygon on the left, so that the sides run in opposite directions.
    const Complex to = stays[0] - stays[1], from = moves[1] - moves[0];
    const double longer = std::max(std::abs(to), std::abs(from));
    if (!(longer > 0) || std::abs(std::abs(to) - std::abs(from)) > kSameLength * longer) return true;
    const Complex turn = to / from / std::abs(to / from);
    const bool is_turned = std::ranges::any_of(islands_[other], [&](int island) {
      return is_held_[island] && (turn * motions_[island].turn).real() < kHeldTurn;
    });
    if (is_turned) return false;
    // Middles coincide: a small difference in length is shared by both ends.
    const Motion motion{turn, (stays[0] + stays[1]) / 2.0 - turn * (moves[0] + moves[1]) / 2.0};
    if (!overlapping(one, other, motion)) unite(one, other, motion);
    return true;
  }

  Points points(int t) const {
    const auto& corners = surface_.triangle_corners[t];
    return {at(corners[0]), at(corners[1]), at(corners[2])};
  }

  template <class Visit>
  void for_triangles(int net, const Visit& visit) const {
    for (const int island : islands_[net]) {
      for (const int t : triangles_[island]) visit(points(t));
    }
  }

  // Whether the net `other`, moved, lies on `one`.
  bool overlapping(int one, int other, const Motion& motion) const {
    std::vector<Points> arriving;
    Box all;
    for_triangles(other, [&](Points t) {
      for (Complex& z : t) all.add(z = motion(z));
      arriving.push_back(t);
    });
    bool found = false;
    Execution::count(static_cast<double>(sizes_[one] + sizes_[other]));
    for_triangles(one, [&](const Points& t) {
      const Box box = box_of(t);
      if (found || !box.meets(all)) return;
      Execution::count(static_cast<double>(arriving.size()));
      execution_.report(done_);
      found = std::any_of(arriving.begin(), arriving.end(),
                          [&](const Points& other_t) { return box.meets(box_of(other_t)) && overlap(t, other_t); });
    });
    return found;
  }

  void unite(int one, int other, const Motion& motion) {
    for (const int island : islands_[other]) {
      // The new motion follows the old one: motion(turn z + shift) = (motion.turn turn) z + motion(shift).
      motions_[island] = {motion.turn * motions_[island].turn, motion(motions_[island].shift)};
      net_[island] = one;
      islands_[one].push_back(island);
    }
    islands_[other].clear();
    sizes_[one] += sizes_[other];
  }

  const mesh::Surface& surface_;
  const uv::UvArray& uv_;
  const std::vector<char>& is_held_;
  Execution& execution_;
  double done_ = 0;  // part of the work
  std::vector<int> corner_islands_;
  std::vector<std::vector<int>> triangles_, islands_;  // in each island; in each net
  std::vector<Motion> motions_;                        // each island's
  std::vector<int> net_, sizes_;                       // each island's net; triangles in each net
};

// Each island: the lowest one of its net.
std::vector<int> lowest_of_nets(const Nets& nets, int count) {
  std::vector<int> lowest(count, -1), result(count);
  for (int k = 0; k < count; ++k) {
    int& first = lowest[nets.net_of(k)];
    if (first < 0) first = k;
    result[k] = first;
  }
  return result;
}

// Moves islands rigidly so that the sides of a joint coincide, one joint after the other. Skips a joint unless its
// sides have equal lengths and belong to different nets that then do not overlap, and no island that is held would be
// turned by more than 5 degrees, all in all.
// @param surface cut open along its seams. @param uv #C x 2, changed. @param joints in the order in which they are
// tried
// @param is_joinable each component: whether it may be moved. @param is_held each one: whether it keeps its direction
// @return each component: the lowest one of its net. @throws Cancelled
// Cost: at most kMostTriangles tests of two triangles for each triangle of the surface.
std::vector<int> joined(const mesh::Surface& surface, uv::UvArray& uv, const std::vector<Joint>& joints,
                        const std::vector<char>& is_joinable, const std::vector<char>& is_held, Execution& execution) {
  const uv::UvArray flat = uv;
  Nets nets(surface, flat, is_held, execution);
  for (std::size_t k = 0; k < joints.size(); ++k) {
    const Joint& joint = joints[k];
    nets.report(static_cast<double>(k) / static_cast<double>(joints.size()));
    if (is_joinable[nets.island_at(joint[0])] && is_joinable[nets.island_at(joint[2])]) nets.join(joint);
  }
  for (int c = 0; c < static_cast<int>(flat.rows()); ++c) uv.row(c) << nets.at(c).real(), nets.at(c).imag();
  return lowest_of_nets(nets, surface.component_count);
}

using Axis = std::array<double, 3>;

constexpr double kMargin = 0.02;  // between islands, in sides of the square that they are packed into
// Part of the area over which the axis is seen, from which on it counts.
constexpr double kShown = 0.2;
constexpr double kTurned = 1e-3;  // 1 less the cosine of an angle that is a turn
// UV distance over the size of the map, below which the two sides of an edge are at one place.
constexpr double kSame = 1e-5;
constexpr double kDigits = 1e6;  // of lengths over the longest one: those that differ by less are alike

// What is up on an island: the first of these that it shows.
std::array<Axis, 3> axes(uv::Up up) {
  if (up == uv::Up::kY) return {Axis{0, 1, 0}, Axis{0, 0, -1}, Axis{1, 0, 0}};
  return {Axis{0, 0, 1}, Axis{0, 1, 0}, Axis{1, 0, 0}};
}

Complex at(const uv::UvArray& uv, int corner) { return {uv(corner, 0), uv(corner, 1)}; }

// Component of each corner.
std::vector<int> corner_pieces(const mesh::Surface& pieces) {
  std::vector<int> result(pieces.polygons.corner_vertices.size());
  const auto& offsets = pieces.polygons.face_offsets;
  for (std::size_t f = 0; f < pieces.face_component.size(); ++f)
    std::fill(result.begin() + offsets[f], result.begin() + offsets[f + 1], pieces.face_component[f]);
  return result;
}

// The joints whose pieces stay as they are turned first, and longer ones before shorter ones.
std::vector<Joint> preferred(const uv::UvArray& uv, const std::vector<Joint>& joints) {
  struct Key {
    bool turns;
    double length;
  };
  std::vector<Key> keys(joints.size());
  double longest = 0;
  for (std::size_t k = 0; k < joints.size(); ++k) {
    const auto& [a, b, c, d] = joints[k];
    const Complex to = at(uv, b) - at(uv, a), come = at(uv, c) - at(uv, d);
    const double length = std::abs(to), cosine = (to * std::conj(come)).real() / (length * std::abs(come));
    keys[k] = {!(cosine >= 1 - kTurned), length};
    longest = std::max(longest, length);
  }
  for (Key& key : keys) key.length = std::nearbyint(key.length / (longest > 0 ? longest : 1) * kDigits);
  std::vector<std::size_t> order(joints.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, [&](std::size_t i, std::size_t j) {
    return std::tuple(keys[i].turns, -keys[i].length) < std::tuple(keys[j].turns, -keys[j].length);
  });
  std::vector<Joint> result;
  for (const std::size_t k : order) result.push_back(joints[k]);
  return result;
}

// Moves nets side by side. @param net of each corner. @return how many there are
int pack_nets(uv::UvArray& uv, const std::vector<int>& net) {
  std::vector<int> number(1 + *std::ranges::max_element(net), -1);
  for (const int k : net) number[k] = 0;
  int count = 0;
  for (int& own : number) own = own < 0 ? -1 : count++;
  std::vector<Extent> low(count, {kInfinity, kInfinity}), high(count, {-kInfinity, -kInfinity});
  for (Eigen::Index c = 0; c < uv.rows(); ++c) {
    for (int i = 0; i < 2; ++i) {
      const int own = number[net[c]];
      low[own][i] = std::min(low[own][i], uv(c, i));
      high[own][i] = std::max(high[own][i], uv(c, i));
    }
  }
  std::vector<Extent> sizes(count);
  for (int k = 0; k < count; ++k) sizes[k] = {high[k][0] - low[k][0], high[k][1] - low[k][1]};
  const Packing packed = pack(sizes, kMargin);
  for (Eigen::Index c = 0; c < uv.rows(); ++c) {
    for (int i = 0; i < 2; ++i) uv(c, i) += packed.corners[number[net[c]]][i] - low[number[net[c]]][i];
  }
  return count;
}

}  // namespace

double Layout::cost() const { return uv::cost(quality, {soft_length, hard_length}); }
double Layout::seam_cost() const { return uv::cost_of_marks({soft_length, hard_length}); }
double Layout::overlap_cost() const { return uv::cost_of_overlaps(quality.overlapping_part.value_or(0)); }

std::pair<double, double> visible_lengths(const mesh::Surface& surface, double area, const std::vector<double>& breaks,
                                          const std::vector<char>& is_seam) {
  double soft = 0, hard = 0;
  for (std::size_t e = 0; e < is_seam.size(); ++e) {
    if (!is_seam[e]) continue;
    const double seen = mesh::seen(breaks[e]);
    soft += surface.edge_lengths[e] * seen;
    hard += surface.edge_lengths[e] * (1 - seen);
  }
  const double root = std::sqrt(area);
  return {soft / root, hard / root};
}

std::optional<Flattened> Flattened::of(const Sheet& sheet, const Cuts& cuts, Execution& execution) {
  mesh::Surface pieces = cuts.pieces(execution);
  Flattening flat = flattened(pieces, execution);
  if (std::ranges::find(flat.is_flat, 0) != flat.is_flat.end()) return std::nullopt;
  return Flattened(sheet, cuts, std::move(pieces), std::move(flat));
}

uv::UvArray Flattened::evened(double evenness, Execution& execution) const {
  return flat::evened(pieces_, flat_, evenness, execution);
}

Layout Flattened::laid_out(const uv::UvArray& flat_uv, double evenness, const Layout* conformal, bool joins,
                           Execution& execution) const {
  const mesh::Surface& surface = sheet_->surface;
  uv::UvArray uv = flat_uv;
  std::vector<char> is_held = turn_upright(uv);
  if (!sheet_->is_upright) std::ranges::fill(is_held, 0);
  const std::vector<Joint> joints = cuts_.joints();
  execution.stage("joints", 0, 1);
  std::vector<int> nets(pieces_.component_count);
  std::iota(nets.begin(), nets.end(), 0);
  if (joins) nets = joined(pieces_, uv, preferred(uv, joints), flat_.is_flat, is_held, execution);
  execution.stage("layout", 0, 1);
  std::vector<int> net = corner_pieces(pieces_);
  net.resize(surface.polygons.corner_vertices.size());
  for (int& own : net) own = nets[own];
  Layout result;
  result.uv = uv.topRows(static_cast<Eigen::Index>(net.size()));
  result.islands = pack_nets(result.uv, net);
  const std::vector<char> is_seam = seams(result.uv, joints);
  for (std::size_t e = 0; e < is_seam.size(); ++e) {
    if (is_seam[e]) result.seams.push_back(surface.edges[e]);
  }
  std::tie(result.soft_length, result.hard_length) = visible_lengths(surface, sheet_->area, sheet_->breaks, is_seam);
  result.quality = quality(result.uv, execution);
  if (conformal) uv::set_evened_from(result.quality, conformal->quality, evenness);
  result.evenness = evenness;
  return result;
}

// Turns each piece about 0 so that the axis which it shows most of runs up. @return #pieces, whether that is what is up
// in space
std::vector<char> Flattened::turn_upright(uv::UvArray& uv) const {
  const auto piece_of = [&](std::size_t t) { return pieces_.face_component[pieces_.triangle_faces[t]]; };
  std::vector<double> areas(pieces_.component_count, 0.0);
  const auto normals = mesh::triangle_normals(pieces_);
  for (std::size_t t = 0; t < normals.size(); ++t) {
    const auto& [x, y, z] = normals[t];
    areas[piece_of(t)] += std::sqrt(x * x + y * y + z * z) / 2;
  }
  std::vector<Complex> turn(areas.size(), 1.0);
  std::vector<char> is_open(areas.size(), 1), is_held(areas.size(), 0);
  const std::array<Axis, 3> tried = axes(sheet_->up);
  for (const Axis& axis : tried) {
    std::vector<Complex> slopes(areas.size(), 0.0), squares(areas.size(), 0.0);
    for (std::size_t t = 0; t < normals.size(); ++t) {
      const Complex slope = uv::uphill(pieces_, uv, static_cast<int>(t), axis);
      slopes[piece_of(t)] += slope;
      if (slope != 0.0) squares[piece_of(t)] += slope * slope / std::abs(slope);
    }
    for (std::size_t k = 0; k < areas.size(); ++k) {
      const Complex i(0, 1), mean = slopes[k], level = std::sqrt(squares[k]);
      // Around a lying tube slopes cancel: it goes up on one side, and down on the other. Their squares do not.
      const Complex more = (mean * std::conj(level)).real() < 0 ? -level : level;
      const Complex along = std::abs(mean) > kShown * areas[k] ? mean : more;
      if (!is_open[k] || !(std::max(std::abs(mean), std::norm(level)) > kShown * areas[k])) continue;
      turn[k] = i * std::abs(along) / along;
      is_open[k] = 0;
      is_held[k] = &axis == &tried.front() ? 1 : 0;
    }
  }
  const std::vector<int> piece = corner_pieces(pieces_);
  for (std::size_t c = 0; c < piece.size(); ++c) {
    const Complex z = at(uv, static_cast<int>(c)) * turn[piece[c]];
    uv.row(static_cast<Eigen::Index>(c)) << z.real(), z.imag();
  }
  return is_held;
}

// The edges that are cut, but those at whose two sides the UVs are the same, #E.
std::vector<char> Flattened::seams(const uv::UvArray& uv, const std::vector<Joint>& joints) const {
  std::vector<char> result = cuts_.is_cut();
  const double size = (uv.colwise().maxCoeff() - uv.colwise().minCoeff()).maxCoeff();
  for (const auto& [a, b, c, d] : joints) {
    const double gap = std::max(std::abs(at(uv, a) - at(uv, d)), std::abs(at(uv, b) - at(uv, c)));
    if (gap <= kSame * size) result[cuts_.sides().edge[a]] = 0;
  }
  return result;
}

// On the triangles of the surface; overlaps are measured within seams and boundary.
uv::Quality Flattened::quality(const uv::UvArray& uv, Execution& execution) const {
  const mesh::Surface& surface = sheet_->surface;
  std::vector<uv::Ends> border;
  const auto& [edges, following] = cuts_.sides();
  for (int c = 0; c < std::ssize(edges); ++c) {
    if (cuts_.is_cut()[edges[c]] || surface.edge_face_count[edges[c]] == 1)
      border.push_back({at(uv, c), at(uv, following[c])});
  }
  uv::Quality result = uv::quality(surface, uv, execution.workers());
  if (sheet_->is_upright) result.direction = uv::direction(surface, uv, sheet_->up, 1, execution.workers());
  execution.stage("overlaps", 0, 1);
  result.overlapping_part = uv::overlapping_part(border, execution);
  return result;
}

}  // namespace holomorph::flat
