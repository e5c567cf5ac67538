#include "moduli/similarities.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "mesh/triangle_geometry.h"

namespace holomorph::moduli {
namespace {

using mesh::Surface;

// Side 3 t + i on the other side of each side's edge, -1 on the boundary.
std::vector<int> twins(const Surface& surface) {
  std::vector<int> first(surface.edges.size(), -1), result(3 * surface.triangles.size(), -1);
  for (int side = 0; side < static_cast<int>(result.size()); ++side) {
    int& other = first[surface.triangle_edges[side / 3][side % 3]];
    if (other >= 0) {
      result[side] = other;
      result[other] = side;
    }
    other = side;
  }
  return result;
}

int next(int side, int step) { return 3 * (side / 3) + (side % 3 + 3 + step) % 3; }

class Search {
 public:
  Search(const Surface& a, const Surface& b, const SimilarityOptions& options, Execution& execution)
      : a_(a), b_(b), options_(options), execution_(execution), twins_a_(twins(a)), twins_b_(twins(b)) {
    steps_left_ = options.triangles * static_cast<std::int64_t>(a.triangles.size());
  }

  std::vector<Similarity> run() {
    std::vector<Similarity> found;
    if (a_.triangles.size() != b_.triangles.size() || a_.edges.size() != b_.edges.size()) return found;
    const auto sum = [](const Surface& s) {
      return std::accumulate(s.edge_lengths.begin(), s.edge_lengths.end(), 0.0);
    };
    scale_ = sum(b_) / sum(a_);
    const auto longest = std::max_element(a_.edge_lengths.begin(), a_.edge_lengths.end()) - a_.edge_lengths.begin();
    const int from = side_of_edge(static_cast<int>(longest));
    for (int to = 0; to < static_cast<int>(twins_b_.size()) && found.size() < options_.most && steps_left_ > 0; ++to) {
      if (!fits(from, to)) continue;
      if (auto made = walk(from, to)) found.push_back(std::move(*made));
    }
    return found;
  }

 private:
  double length(const Surface& s, int side) const { return s.edge_lengths[s.triangle_edges[side / 3][side % 3]]; }

  int side_of_edge(int edge) const {
    int side = 0;
    while (a_.triangle_edges[side / 3][side % 3] != edge) ++side;
    return side;
  }

  // Whether the triangles beside two sides are similar, and both or none of the sides are on the boundary.
  bool fits(int from, int to) {
    const int sign = options_.sign;
    double a[3], b[3];
    for (int i = 0; i < 3; ++i) {
      const int side = next(from, i), image = next(to, sign * i);
      if ((twins_a_[side] < 0) != (twins_b_[image] < 0)) return false;
      a[i] = scale_ * length(a_, side);
      b[i] = length(b_, image);
    }
    // A triangle without area has no dilatation; the same lengths need none.
    const double dilatation = std::equal(a, a + 3, b) ? 0 : this->dilatation(a, b),
                 size = std::abs(std::log(b[0] / a[0]));
    if (!(std::max(dilatation, size) <= kSimilar)) return false;
    largest_ = std::max(largest_, dilatation);
    return true;
  }

  // log(s1 / s2) of the map between two triangles. With the first sides along the real axis it is [[s, p], [0, q]], and
  // s1/s2 + s2/s1 - 2 = ((s - q)^2 + p^2) / (s q), which has no cancellation.
  static double dilatation(const double (&a)[3], const double (&b)[3]) {
    const auto apex = [](const double(&l)[3]) {
      const double along = ((l[2] - l[1]) * (l[2] + l[1]) / l[0] + l[0]) / 2;
      return std::array{along, 2 * mesh::triangle_area(l[0], l[1], l[2]) / l[0]};
    };
    const auto from = apex(a), to = apex(b);
    const double s = b[0] / a[0], q = to[1] / from[1], p = (to[0] - s * from[0]) / from[1];
    return 2 * std::asinh(std::sqrt(((s - q) * (s - q) + p * p) / (s * q)) / 2);
  }

  std::optional<Similarity> walk(int from, int to) {
    Similarity result{options_.sign, std::vector<int>(a_.triangles.size(), -1), 0};
    std::vector<char> is_image(b_.triangles.size(), 0);
    std::vector<int> queue;
    largest_ = 0;
    const auto reach = [&](int side, int image) {
      int& known = result.sides[side / 3];
      const int first = next(image, -options_.sign * (side % 3));
      if (known >= 0) return known == first;
      if (is_image[image / 3] || !fits(side, image)) return false;
      known = first;
      is_image[image / 3] = 1;
      queue.push_back(side / 3);
      return true;
    };
    if (!reach(from, to)) return {};
    for (std::size_t i = 0; i < queue.size(); ++i) {
      execution_.step(i, a_.triangles.size());
      if (--steps_left_ < 0) return {};
      for (int k = 0; k < 3; ++k) {
        const int side = 3 * queue[i] + k, image = next(result.sides[queue[i]], options_.sign * k);
        if (twins_a_[side] >= 0 && !reach(twins_a_[side], twins_b_[image])) return {};
      }
    }
    if (queue.size() != a_.triangles.size()) return {};  // @pre: connected
    result.dilatation = largest_;
    return result;
  }

  const Surface &a_, &b_;
  SimilarityOptions options_;
  Execution& execution_;
  std::vector<int> twins_a_, twins_b_;
  std::int64_t steps_left_;
  double scale_ = 1, largest_ = 0;
};

}  // namespace

std::vector<Similarity> similarities(const Surface& a, const Surface& b, const SimilarityOptions& options,
                                     Execution& execution) {
  return Search(a, b, options, execution).run();
}

}  // namespace holomorph::moduli
