#include "islands/merge_islands.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>

#include "islands/split_overlaps.h"

namespace holomorph::islands {
namespace {

constexpr int kMostTriangles = 4096;                          // the most in a net: all pairs of two nets are tested
constexpr double kSameLength = 1e-3;                          // difference over the longer side
const double kTurned = std::cos(5 * std::numbers::pi / 180);  // of an island that is held

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
      return is_held_[island] && (turn * motions_[island].turn).real() < kTurned;
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

}  // namespace

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

}  // namespace holomorph::islands
