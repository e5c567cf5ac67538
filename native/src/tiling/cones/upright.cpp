#include "tiling/cones/upright.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "base/constants.h"

namespace holomorph::tiling {
namespace {

constexpr double kSteep = 0.35;     // least sine between the normal and the vertical, as in quality/quality.py
constexpr double kOnItsHead = 0.5;  // beside 1 for what lies on its side, as in quality/appearance.py
// The price of an edge that turns and is as long as the root of the area, where it is smooth. It falls to the part
// where the edge bends by the angle. Little, as no texture that the map is made for shows where it turns.
constexpr double kSeam = 0.02, kSeenAtHard = 0.06, kHides = std::numbers::pi / 3;
constexpr int kUprightRounds =
    30;  // at most, and looks at each polygon or region in one: they end where nothing is gained
constexpr double kLessTurned = 1e-9;

// What is minded of a texture turned by this angle from up.
double minded(double angle) {
  const double sine = std::abs(std::sin(angle));
  return std::cos(angle) < 0 ? kOnItsHead + (1 - kOnItsHead) * sine : sine;
}

// Visits the triangles that are steep, with the angle by which u is turned there from where it is to run.
template <class Visit>
void for_steep(const mesh::Surface& surface, const Net& net, const uv::UvArray& in_plane, const Along& along,
               const Visit& visit) {
  const Level level = level_directions(net, surface.polygons.vertices, along);
  const auto cross = [](Complex a, Complex b) { return (std::conj(a) * b).imag(); };
  for (int t = 0; t < net.triangle_count(); ++t) {
    if (!(level.steepness[t] > kSteep * kSteep)) continue;
    const auto at = [&](int corner) {
      const auto row = in_plane.row(surface.triangle_corners[t][corner]);
      return Complex(row[0], row[1]);
    };
    // The wanted direction as a sum of sides of the triangle, and in the map.
    const Complex wanted = level.direction[t], first = net.along[3 * t], last = -net.along[3 * t + 2];
    visit(t, std::arg(cross(wanted, last) * (at(1) - at(0)) + cross(first, wanted) * (at(2) - at(0))));
  }
}

Eigen::Vector3d normal(const mesh::Surface& surface, int t) {
  const auto at = [&](int i) { return Eigen::Vector3d(surface.polygons.vertices[surface.triangles[t][i]].data()); };
  return (at(1) - at(0)).cross(at(2) - at(0));
}

// The angle between the normals of two triangles.
double bend(const mesh::Surface& surface, int one, int other) {
  const Eigen::Vector3d a = normal(surface, one), b = normal(surface, other);
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

// An edge between two polygons: what turns across it, but for their own turns, from the one to the other.
struct Link {
  int one, other, turn;
  double price;
};

class Turner {
 public:
  Turner(const mesh::Surface& surface, const Net& net, const uv::UvArray& in_plane, int k, const Along& along,
         const std::vector<int>& turn)
      : k_(k), count_(static_cast<int>(surface.polygons.face_offsets.size()) - 1), minded_(count_ * k, 0.0) {
    find_minded(surface, net, in_plane, along);
    find_links(surface, net, turn);
  }

  std::vector<int> best() {
    std::vector<int> as_given = lowered(std::vector<int>(count_, 0)), from_up = lowered(upright());
    return cost(from_up) < cost(as_given) ? from_up : as_given;
  }

 private:
  int reduced(int r) const { return ((r % k_) + k_) % k_; }
  int left(const Link& link, const std::vector<int>& s) const {
    return reduced(link.turn + s[link.other] - s[link.one]);
  }

  void find_minded(const mesh::Surface& surface, const Net& net, const uv::UvArray& in_plane, const Along& along) {
    for_steep(surface, net, in_plane, along, [&](int t, double angle) {
      for (int s = 0; s < k_; ++s) {
        minded_[surface.triangle_faces[t] * k_ + s] += net.area[t] / net.whole_area * minded(angle + kTwoPi / k_ * s);
      }
    });
  }

  void find_links(const mesh::Surface& surface, const Net& net, const std::vector<int>& turn) {
    of_polygon_.resize(count_);
    for (int side = 0; side < net.side_count(); ++side) {
      const int back = net.twin[side];
      if (back < side) continue;
      const int one = surface.triangle_faces[side / 3], other = surface.triangle_faces[back / 3];
      if (one == other) continue;
      of_polygon_[one].push_back(static_cast<int>(links_.size()));
      of_polygon_[other].push_back(static_cast<int>(links_.size()));
      const double seen = std::max(1 - bend(surface, side / 3, back / 3) / kHides, kSeenAtHard);
      const double length = std::abs(net.along[side]) / std::sqrt(net.whole_area);
      links_.push_back({one, other, std::max(turn[side], 0), kSeam * length * seen});
    }
  }

  double cost(const std::vector<int>& s) const {
    double sum = 0;
    for (int p = 0; p < count_; ++p) sum += minded_[p * k_ + s[p]];
    for (const Link& link : links_) sum += left(link, s) != 0 ? link.price : 0;
    return sum;
  }

  // Each steep polygon as is best for it alone; the others continue their neighbours.
  std::vector<int> upright() const {
    std::vector<int> s(count_, -1), queue;
    for (int p = 0; p < count_; ++p) {
      const auto first = minded_.begin() + p * k_, last = first + k_;
      const auto least = std::min_element(first, last);
      if (!(*std::max_element(first, last) > *least)) continue;
      s[p] = static_cast<int>(least - first);
      queue.push_back(p);
    }
    for (std::size_t i = 0; i < queue.size(); ++i) {
      for (const int l : of_polygon_[queue[i]]) {
        const Link& link = links_[l];
        const bool is_one = link.one == queue[i];
        const int next = is_one ? link.other : link.one;
        if (s[next] >= 0) continue;
        s[next] = reduced(is_one ? s[link.one] - link.turn : s[link.other] + link.turn);
        queue.push_back(next);
      }
    }
    for (int& own : s) own = std::max(own, 0);
    return s;
  }

  std::vector<int> lowered(std::vector<int> s) const {
    for (int round = 0; round < kUprightRounds; ++round) {
      std::vector<int> alone(count_);
      for (int p = 0; p < count_; ++p) alone[p] = p;
      const bool moved = turn_regions(alone, count_, s);
      int count = 0;
      const std::vector<int> region = regions(s, count);
      if (!turn_regions(region, count, s) && !moved) break;
    }
    return s;
  }

  // #polygons, those that are joined by edges that do not turn.
  std::vector<int> regions(const std::vector<int>& s, int& count) const {
    std::vector<int> region(count_, -1), queue;
    count = 0;
    for (int p = 0; p < count_; ++p) {
      if (region[p] >= 0) continue;
      region[p] = count++;
      queue.assign(1, p);
      while (!queue.empty()) {
        const int own = queue.back();
        queue.pop_back();
        for (const int l : of_polygon_[own]) {
          const Link& link = links_[l];
          const int next = link.one == own ? link.other : link.one;
          if (region[next] >= 0 || left(link, s) != 0) continue;
          region[next] = region[own];
          queue.push_back(next);
        }
      }
    }
    return region;
  }

  // Turns regions one after the other while that makes one better; then those beside it are looked at again.
  // @return whether there was one
  bool turn_regions(const std::vector<int>& region, int count, std::vector<int>& s) const {
    std::vector<double> minded(static_cast<std::size_t>(count) * k_, 0.0);
    for (int p = 0; p < count_; ++p) {
      for (int r = 0; r < k_; ++r) minded[region[p] * k_ + r] += minded_[p * k_ + reduced(s[p] + r)];
    }
    std::vector<std::vector<int>> of_region(count);  // links to others
    for (int l = 0; l < std::ssize(links_); ++l) {
      const int one = region[links_[l].one], other = region[links_[l].other];
      if (one != other) of_region[one].push_back(l), of_region[other].push_back(l);
    }
    std::vector<int> by(count, 0), queue(count);
    std::iota(queue.begin(), queue.end(), 0);
    std::vector<char> waits(count, 1);
    const std::size_t most = static_cast<std::size_t>(kUprightRounds) * count;
    for (std::size_t i = 0; i < queue.size() && i < most; ++i) {
      const int own = queue[i];
      waits[own] = 0;
      // What is minded, less the prices of the links that do not turn then.
      std::vector<double> price(minded.begin() + own * k_, minded.begin() + (own + 1) * k_);
      for (const int l : of_region[own]) {
        const Link& link = links_[l];
        const int one = region[link.one], other = region[link.other], now = left(link, s);
        price[one == own ? reduced(now + by[other]) : reduced(by[one] - now)] -= link.price;
      }
      const int best = static_cast<int>(std::ranges::min_element(price) - price.begin());
      if (!(price[best] < price[by[own]] - kLessTurned)) continue;
      by[own] = best;
      for (const int l : of_region[own]) {
        const int one = region[links_[l].one], next = one == own ? region[links_[l].other] : one;
        if (!std::exchange(waits[next], 1)) queue.push_back(next);
      }
    }
    for (int p = 0; p < count_; ++p) s[p] = reduced(s[p] + by[region[p]]);
    return std::ranges::any_of(by, [](int r) { return r != 0; });
  }

  int k_, count_;
  std::vector<double> minded_;  // #polygons x k
  std::vector<Link> links_;
  std::vector<std::vector<int>> of_polygon_;  // links
};

}  // namespace

std::vector<int> upright_turns(const mesh::Surface& surface, const Net& net, const uv::UvArray& in_plane, int k,
                               const Along& along, const std::vector<int>& turn) {
  const std::vector<int> of_polygon = Turner(surface, net, in_plane, k, along, turn).best();
  std::vector<int> result(net.triangle_count());
  for (int t = 0; t < net.triangle_count(); ++t) result[t] = of_polygon[surface.triangle_faces[t]];
  return result;
}

double off_level(const mesh::Surface& surface, const Net& net, const uv::UvArray& in_plane, int k, const Along& along) {
  double sum = 0;
  for_steep(surface, net, in_plane, along, [&](int t, double angle) {
    const double unit = kTwoPi / k;
    sum += net.area[t] / net.whole_area * minded(angle - unit * std::round(angle / unit));
  });
  return sum;
}

}  // namespace holomorph::tiling
