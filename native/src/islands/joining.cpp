#include "islands/joining.h"

#include <algorithm>
#include <array>
#include <complex>
#include <limits>
#include <numeric>

namespace holomorph::islands {
namespace {

using Complex = std::complex<double>;
using Points = std::array<Complex, 3>;

constexpr int kMostTriangles = 4096;   // of a net: larger islands are pictures of their own
constexpr double kSameLength = 1e-3;   // of the longer side
constexpr double kTouching = 1e-6;     // of a triangle's size: so deep do triangles lie in each other that only touch
constexpr double kLeastWidth = 1e-12;  // of the squared length

double cross(Complex a, Complex b) { return (std::conj(a) * b).imag(); }

// z -> turn z + shift
struct Motion {
  Complex turn = 1, shift = 0;
  Complex operator()(Complex z) const { return turn * z + shift; }
};

struct Box {
  double left = std::numeric_limits<double>::infinity(), low = left, right = -left, high = -left;

  void add(Complex z) {
    left = std::min(left, z.real()), right = std::max(right, z.real());
    low = std::min(low, z.imag()), high = std::max(high, z.imag());
  }
  bool meets(const Box& other) const {
    return left < other.right && other.left < right && low < other.high && other.low < high;
  }
};

Box box_of(const Points& triangle) {
  Box box;
  for (const Complex z : triangle) box.add(z);
  return box;
}

// Whether a side of `a` parts the two, up to a little.
bool side_parts(const Points& a, const Points& b) {
  for (int i = 0; i < 3; ++i) {
    const Complex side = a[(i + 1) % 3] - a[i];
    const double length = std::abs(side);
    if (!(length > 0)) continue;
    double deepest = 0, inner = 0;
    for (int j = 0; j < 3; ++j) {
      deepest = std::max(deepest, cross(side, b[j] - a[i]) / length);
      inner = std::max(inner, cross(side, a[j] - a[i]) / length);
    }
    if (deepest <= kTouching * std::max(length, inner)) return true;
  }
  return false;
}

// Counter-clockwise; a triangle without area overlaps nothing.
bool overlap(const Points& a, const Points& b) {
  for (const Points* t : {&a, &b}) {
    const Complex one = (*t)[1] - (*t)[0], other = (*t)[2] - (*t)[0];
    if (!(cross(one, other) > kLeastWidth * (std::norm(one) + std::norm(other)))) return false;
  }
  return !side_parts(a, b) && !side_parts(b, a);
}

class Nets {
 public:
  Nets(const mesh::Surface& surface, const uv::UvArray& uv) : surface_(surface), uv_(uv) {
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

  void join(Joint joint) {
    int one = net_[island_at(joint[0])], other = net_[island_at(joint[2])];
    if (one == other || sizes_[one] + sizes_[other] > kMostTriangles) return;
    if (sizes_[one] < sizes_[other]) std::swap(one, other), joint = {joint[2], joint[3], joint[0], joint[1]};
    const std::array<Complex, 2> stays{at(joint[0]), at(joint[1])}, moves{at(joint[2]), at(joint[3])};
    const Complex to = stays[0] - stays[1], from = moves[1] - moves[0];
    const double longer = std::max(std::abs(to), std::abs(from));
    if (!(longer > 0) || std::abs(std::abs(to) - std::abs(from)) > kSameLength * longer) return;
    const Complex turn = to / from / std::abs(to / from);
    const Motion motion{turn, (stays[0] + stays[1]) / 2.0 - turn * (moves[0] + moves[1]) / 2.0};
    if (!overlapping(one, other, motion)) unite(one, other, motion);
  }

 private:
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
    for_triangles(one, [&](const Points& t) {
      const Box box = box_of(t);
      if (found || !box.meets(all)) return;
      found = std::any_of(arriving.begin(), arriving.end(),
                          [&](const Points& other_t) { return box.meets(box_of(other_t)) && overlap(t, other_t); });
    });
    return found;
  }

  void unite(int one, int other, const Motion& motion) {
    for (const int island : islands_[other]) {
      motions_[island] = {motion.turn * motions_[island].turn, motion(motions_[island].shift)};
      net_[island] = one;
      islands_[one].push_back(island);
    }
    islands_[other].clear();
    sizes_[one] += sizes_[other];
  }

  const mesh::Surface& surface_;
  const uv::UvArray& uv_;
  std::vector<int> corner_islands_;
  std::vector<std::vector<int>> triangles_, islands_;  // of each island; of each net
  std::vector<Motion> motions_;                        // of each island
  std::vector<int> net_, sizes_;                       // of each island; triangles of each net
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
                        const std::vector<char>& is_joinable) {
  const uv::UvArray flat = uv;
  Nets nets(surface, flat);
  for (const Joint& joint : joints) {
    if (is_joinable[nets.island_at(joint[0])] && is_joinable[nets.island_at(joint[2])]) nets.join(joint);
  }
  for (int c = 0; c < static_cast<int>(flat.rows()); ++c) uv.row(c) << nets.at(c).real(), nets.at(c).imag();
  return lowest_of_nets(nets, surface.component_count);
}

}  // namespace holomorph::islands
