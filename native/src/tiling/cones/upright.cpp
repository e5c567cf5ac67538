#include "tiling/cones/upright.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>

#include "base/constants.h"
#include "mesh/union_find.h"

namespace holomorph::tiling {
namespace {

constexpr double kSteep = 0.35;     // least sine between the normal and the vertical, as in quality/quality.py
constexpr double kOnItsHead = 0.5;  // beside 1 for what lies on its side, as in quality/appearance.py
// The price of an edge that turns and is as long as the root of the area, where it is smooth. It falls to the part
// where the edge bends by the angle. Little, as no texture that the map is made for shows where it turns.
constexpr double kSeam = 0.02, kSeenAtHard = 0.06, kHides = std::numbers::pi / 3;
constexpr int kLooks = 30;  // at each node, at most: they end where nothing is gained
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

// What turns across edges between two nodes, polygons or regions that turn as one, from the one to the other.
struct Link {
  int one, other, turn;
  double price;  // where it is not 0
};

struct Graph {
  int k;
  std::vector<double> minded;  // #nodes x k, when a node is turned by so much
  std::vector<Link> links;

  int count() const { return static_cast<int>(minded.size()) / k; }
  int reduced(int r) const { return ((r % k) + k) % k; }
  int left(const Link& link, const std::vector<int>& by) const {
    return reduced(link.turn + by[link.other] - by[link.one]);
  }
  double cost(const std::vector<int>& by) const {
    double sum = 0;
    for (int p = 0; p < count(); ++p) sum += minded[p * k + by[p]];
    for (const Link& link : links) sum += left(link, by) != 0 ? link.price : 0;
    return sum;
  }
  // Finds the links of each node.
  void index() {
    first.assign(count() + 1, 0);
    for (const Link& link : links) ++first[link.one + 1], ++first[link.other + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());
    of_node.resize(2 * links.size());
    std::vector<int> next(first.begin(), first.end() - 1);
    for (int l = 0; l < std::ssize(links); ++l) of_node[next[links[l].one]++] = of_node[next[links[l].other]++] = l;
  }
  std::span<const int> links_of(int node) const {
    return std::span(of_node).subspan(first[node], first[node + 1] - first[node]);
  }

  std::vector<int> first = {}, of_node = {};
};

Graph polygons_of(const mesh::Surface& surface, const Net& net, const uv::UvArray& in_plane, int k, const Along& along,
                  const std::vector<int>& turn) {
  const auto count = surface.polygons.face_offsets.size() - 1;
  Graph result{k, std::vector<double>(count * k, 0.0), {}};
  for_steep(surface, net, in_plane, along, [&](int t, double angle) {
    for (int s = 0; s < k; ++s) {
      result.minded[surface.triangle_faces[t] * k + s] += net.area[t] / net.whole_area * minded(angle + kTwoPi / k * s);
    }
  });
  for (int side = 0; side < net.side_count(); ++side) {
    const int back = net.twin[side];
    if (back < side) continue;
    const int one = surface.triangle_faces[side / 3], other = surface.triangle_faces[back / 3];
    if (one == other) continue;
    const double seen = std::max(1 - bend(surface, side / 3, back / 3) / kHides, kSeenAtHard);
    const double length = std::abs(net.along[side]) / std::sqrt(net.whole_area);
    const bool is_left = net.tail[side] == surface.edges[net.edge[side]][0];
    const int own = turn[net.edge[side]];
    result.links.push_back({one, other, is_left ? own : result.reduced(-own), kSeam * length * seen});
  }
  result.index();
  return result;
}

// Each steep node as is best for it alone; the others continue their neighbours.
std::vector<int> upright(const Graph& graph) {
  std::vector<int> s(graph.count(), -1), queue;
  for (int p = 0; p < graph.count(); ++p) {
    const auto first = graph.minded.begin() + p * graph.k, last = first + graph.k;
    const auto least = std::min_element(first, last);
    if (!(*std::max_element(first, last) > *least)) continue;
    s[p] = static_cast<int>(least - first);
    queue.push_back(p);
  }
  for (std::size_t i = 0; i < queue.size(); ++i) {
    for (const int l : graph.links_of(queue[i])) {
      const Link& link = graph.links[l];
      const bool is_one = link.one == queue[i];
      const int next = is_one ? link.other : link.one;
      if (s[next] >= 0) continue;
      s[next] = graph.reduced(is_one ? s[link.one] - link.turn : s[link.other] + link.turn);
      queue.push_back(next);
    }
  }
  for (int& own : s) own = std::max(own, 0);
  return s;
}

// Turns nodes one after the other while that makes one better; then those beside it are looked at again.
void turn_nodes(const Graph& graph, std::vector<int>& by) {
  std::vector<int> queue(graph.count());
  std::iota(queue.begin(), queue.end(), 0);
  std::vector<char> waits(graph.count(), 1);
  const std::size_t most = static_cast<std::size_t>(kLooks) * graph.count();
  for (std::size_t i = 0; i < queue.size() && i < most; ++i) {
    const int own = queue[i];
    waits[own] = 0;
    // What is minded, less the prices of the links that do not turn then.
    std::array<double, 6> price{};
    for (int r = 0; r < graph.k; ++r) price[r] = graph.minded[own * graph.k + r];
    for (const int l : graph.links_of(own)) {
      const Link& link = graph.links[l];
      price[link.one == own ? graph.reduced(link.turn + by[link.other]) : graph.reduced(by[link.one] - link.turn)] -=
          link.price;
    }
    const int best = static_cast<int>(std::min_element(price.begin(), price.begin() + graph.k) - price.begin());
    if (!(price[best] < price[by[own]] - kLessTurned)) continue;
    by[own] = best;
    for (const int l : graph.links_of(own)) {
      const int next = graph.links[l].one == own ? graph.links[l].other : graph.links[l].one;
      if (!std::exchange(waits[next], 1)) queue.push_back(next);
    }
  }
}

// The graph of nodes that are joined by links that do not turn, as they are turned. @param region out: #nodes
Graph of_regions(const Graph& graph, const std::vector<int>& by, std::vector<int>& region) {
  mesh::UnionFind sets(graph.count());
  for (const Link& link : graph.links) {
    if (graph.left(link, by) == 0) sets.join(link.one, link.other);
  }
  region.resize(graph.count());
  int count = 0;
  for (int p = 0; p < graph.count(); ++p) region[p] = sets.lowest(p) == p ? count++ : region[sets.lowest(p)];
  Graph result{graph.k, std::vector<double>(static_cast<std::size_t>(count) * graph.k, 0.0), {}};
  for (int p = 0; p < graph.count(); ++p) {
    for (int r = 0; r < graph.k; ++r)
      result.minded[region[p] * graph.k + r] += graph.minded[p * graph.k + graph.reduced(by[p] + r)];
  }
  for (const Link& link : graph.links) {
    Link own{region[link.one], region[link.other], graph.left(link, by), link.price};
    if (own.one == own.other) continue;
    if (own.one > own.other) own = {own.other, own.one, graph.reduced(-own.turn), own.price};
    result.links.push_back(own);
  }
  std::ranges::stable_sort(result.links, {}, [](const Link& a) { return std::tuple(a.one, a.other, a.turn); });
  std::size_t last = 0;  // those that turn alike become one
  for (std::size_t l = 1; l < result.links.size(); ++l) {
    const Link &link = result.links[l], &before = result.links[last];
    if (std::tuple(link.one, link.other, link.turn) == std::tuple(before.one, before.other, before.turn))
      result.links[last].price += link.price;
    else
      result.links[++last] = link;
  }
  if (!result.links.empty()) result.links.resize(last + 1);
  result.index();
  return result;
}

// Turns nodes, then the regions that these make, and the regions of these, then nodes once more.
void turn_regions(const Graph& graph, std::vector<int>& by) {
  turn_nodes(graph, by);
  std::vector<int> region;
  const Graph regions = of_regions(graph, by, region);
  if (regions.count() == graph.count()) return;
  std::vector<int> more(regions.count(), 0);
  turn_regions(regions, more);
  for (int p = 0; p < graph.count(); ++p) by[p] = graph.reduced(by[p] + more[region[p]]);
  turn_nodes(graph, by);
}

}  // namespace

std::vector<int> upright_turns(const mesh::Surface& surface, const Net& net, const uv::UvArray& in_plane, int k,
                               const Along& along, const std::vector<int>& turn) {
  const Graph graph = polygons_of(surface, net, in_plane, k, along, turn);
  std::vector<int> of_polygon(graph.count(), 0), from_up = upright(graph);
  for (std::vector<int>* const by : {&of_polygon, &from_up}) turn_regions(graph, *by);
  if (graph.cost(from_up) < graph.cost(of_polygon)) of_polygon = std::move(from_up);
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
