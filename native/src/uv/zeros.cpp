#include "uv/zeros.h"

#include <cmath>
#include <complex>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>

#include "base/constants.h"
#include "mesh/half_edges.h"

namespace holomorph::uv {

namespace {

class Clusters {
 public:
  explicit Clusters(int count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }
  int root(int v) {
    while (parent_[v] != v) v = parent_[v] = parent_[parent_[v]];
    return v;
  }
  void join(int a, int b) { parent_[root(a)] = root(b); }

 private:
  std::vector<int> parent_;
};

constexpr int kNone = -1;

// #V the pole, of `poles`, in whose star each vertex lies, or kNone.
std::vector<int> stars(const mesh::Surface& surface, const std::vector<int>& poles) {
  std::vector<int> own(surface.vertex_count, kNone), star(surface.vertex_count, kNone);
  for (int i = 0; i < static_cast<int>(poles.size()); ++i) own[poles[i]] = i;
  for (const auto& triangle : surface.triangles) {
    for (const int pole : triangle) {
      if (own[pole] == kNone) continue;
      for (const int v : triangle) star[v] = own[pole];
    }
  }
  return star;
}

struct Image {
  std::vector<double> angle;                 // sum of the signed angles at each vertex, outside of the poles' stars
  std::vector<std::pair<int, int>> flipped;  // triangles there whose angles are not pi together, by how many turns
};

// #E images of the edges outside the stars of poles, from the lower to the higher vertex. Edges whose image is a point
// get some direction, the same on both sides: so the orders still add up where a form has decayed to rounding.
std::vector<Eigen::RowVector2d> directions(const mesh::Surface& surface, const Eigen::Ref<const UvArray>& uv,
                                           const std::vector<char>& is_pole, const mesh::Sides& sides) {
  std::vector<Eigen::RowVector2d> direction(surface.edges.size(), Eigen::RowVector2d(1, 0));
  for (int t = 0; t < static_cast<int>(surface.triangles.size()); ++t) {
    const auto& corner = surface.triangle_corners[t];
    const auto& [x, y, z] = surface.triangles[t];
    if (is_pole[x] || is_pole[y] || is_pole[z]) continue;
    for (int i = 0; i < 3; ++i) {
      const Eigen::RowVector2d along = uv.row(corner[(i + 1) % 3]) - uv.row(corner[i]);
      if (!along.isZero(0)) direction[surface.triangle_edges[t][i]] = mesh::sign(sides(t, i)) * along;
    }
  }
  return direction;
}

Image image(const mesh::Surface& surface, const Eigen::Ref<const UvArray>& uv, const std::vector<char>& is_pole) {
  const mesh::Sides sides(surface);
  const auto direction = directions(surface, uv, is_pole, sides);
  const auto along = [&](int t, int i) -> Eigen::RowVector2d {
    return mesh::sign(sides(t, i)) * direction[surface.triangle_edges[t][i]];
  };
  Image result{std::vector<double>(surface.vertex_count, 0.0), {}};
  for (int t = 0; t < static_cast<int>(surface.triangles.size()); ++t) {
    const auto& [x, y, z] = surface.triangles[t];
    if (is_pole[x] || is_pole[y] || is_pole[z]) continue;
    double sum = 0;
    for (int i = 0; i < 3; ++i) {
      const Eigen::RowVector2d a = along(t, i), b = -along(t, (i + 2) % 3);
      const double angle = std::atan2(a[0] * b[1] - a[1] * b[0], a.dot(b));
      result.angle[surface.triangles[t][i]] += angle;
      sum += angle;
    }
    // The signed angles of an upright triangle sum to pi, those of a flipped one to -pi, one turn less.
    const auto turns = static_cast<int>(std::lround((std::numbers::pi - sum) / kTwoPi));
    if (turns != 0) result.flipped.emplace_back(t, turns);
  }
  return result;
}

// Counts zeros in the stars of poles, whose triangles have no common image: the image of a link turns once more for
// each zero inside. All of them count for its vertex with the largest angle.
void count_in_stars(const std::vector<int>& star, const std::vector<char>& is_pole, const std::vector<double>& angle,
                    std::vector<int>& index) {
  std::map<int, std::pair<double, int>> found;  // for each star, the turn of its link, and that vertex
  for (int v = 0; v < static_cast<int>(star.size()); ++v) {
    if (star[v] == kNone) continue;
    index[v] = 0;
    if (is_pole[v]) continue;
    auto& [turn, largest] = found.try_emplace(star[v], 0.0, v).first->second;
    turn += angle[v] - std::numbers::pi;
    if (angle[v] > angle[largest]) largest = v;
  }
  for (const auto& [pole, link] : found) index[link.second] = static_cast<int>(std::lround(link.first / kTwoPi));
}

std::vector<char> boundary_vertices(const mesh::Surface& surface) {
  std::vector<char> is_boundary(surface.vertex_count, 0);
  for (std::size_t e = 0; e < surface.edges.size(); ++e) {
    if (surface.edge_face_count[e] == 1) is_boundary[surface.edges[e][0]] = is_boundary[surface.edges[e][1]] = 1;
  }
  return is_boundary;
}

// 0 at vertices without a triangle.
std::vector<int> indices(const mesh::Surface& surface, const std::vector<double>& angle,
                         const std::vector<char>& is_boundary) {
  std::vector<int> index(surface.vertex_count, 0);
  for (const auto& triangle : surface.triangles) {
    for (const int v : triangle) {
      // At a zero of order m the map is like z^(m + 1): the angles around an inner vertex sum to m + 1 full turns. On
      // the boundary, m is the order on the double of the surface, and the turns are half ones.
      const double flat = (is_boundary[v] ? 1 : 2) * std::numbers::pi;
      index[v] = static_cast<int>(std::lround(angle[v] / flat)) - 1;
    }
  }
  return index;
}

// A cluster of indices that touch: inside, and on the boundary, where an order counts half.
struct Cluster {
  int vertex = kNone;  // that it is said to be at: on the boundary where there is one, then of the largest index
  bool is_boundary = false;
  int inside = 0, on_boundary = 0;

  // On the double of the surface an inner zero occurs twice.
  int order() const { return is_boundary ? on_boundary + 2 * inside : inside; }

  void add(int v, bool is_on_boundary, const std::vector<int>& index) {
    (is_on_boundary ? on_boundary : inside) += index[v];
    const bool is_first = vertex == kNone || (is_on_boundary && !is_boundary);
    if (is_first || (is_on_boundary == is_boundary && index[v] > index[vertex])) vertex = v;
    is_boundary = is_boundary || is_on_boundary;
  }

  void add_flipped(int v, bool is_on_boundary, int turns) {
    if (vertex == kNone) {
      vertex = v;
      is_boundary = is_on_boundary;
    }
    inside += turns;
  }
};

Clusters touching(const mesh::Surface& surface, const std::vector<int>& index,
                  const std::vector<std::pair<int, int>>& flipped) {
  Clusters clusters(surface.vertex_count);
  for (const auto& [t, _] : flipped) {
    for (const int v : surface.triangles[t]) clusters.join(v, surface.triangles[t][0]);
  }
  for (const auto& [a, b] : surface.edges) {
    if (index[a] != 0 && index[b] != 0) clusters.join(a, b);
  }
  return clusters;
}

}  // namespace

std::vector<Zero> zeros(const mesh::Surface& surface, const Eigen::Ref<const UvArray>& uv,
                        const std::vector<int>& poles) {
  std::vector<char> is_pole(surface.vertex_count, 0);
  for (const int pole : poles) is_pole[pole] = 1;
  const auto [angle, flipped] = image(surface, uv, is_pole);
  const std::vector<char> is_boundary = boundary_vertices(surface);
  std::vector<int> index = indices(surface, angle, is_boundary);
  count_in_stars(stars(surface, poles), is_pole, angle, index);
  Clusters clusters = touching(surface, index, flipped);
  std::map<int, Cluster> found;
  for (int v = 0; v < surface.vertex_count; ++v) {
    if (index[v] != 0) found[clusters.root(v)].add(v, is_boundary[v], index);
  }
  for (const auto& [t, turns] : flipped) {
    const int v = surface.triangles[t][0];
    found[clusters.root(v)].add_flipped(v, is_boundary[v], turns);
  }
  std::vector<Zero> result;
  for (const auto& [root, cluster] : found) {
    if (cluster.order() != 0) result.push_back({cluster.vertex, cluster.order()});
  }
  return result;
}

void place_apexes(const mesh::Surface& surface, std::span<const mesh::Star> stars, Eigen::Ref<UvArray> uv) {
  for (const mesh::Star& star : stars) {
    for (std::size_t j = 0; j < star.size(); ++j) {
      const int t = star.faces[j];
      const auto& corner = surface.triangle_corners[t];
      const auto& edge = surface.triangle_edges[t];
      int side = 0;  // the one on the link
      while (edge[side] != mesh::edge_of(star.link[j])) ++side;
      const int at_a = corner[side], at_b = corner[(side + 1) % 3], at_p = corner[(side + 2) % 3];
      const Complex a(uv(at_a, 0), uv(at_a, 1)), b(uv(at_b, 0), uv(at_b, 1)), apex = a + star.apexes[j] * (b - a);
      uv.row(at_p) << apex.real(), apex.imag();
    }
  }
}

}  // namespace holomorph::uv
