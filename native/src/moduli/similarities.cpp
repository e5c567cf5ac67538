#include "moduli/similarities.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

#include "base/constants.h"
#include "mesh/metric_errors.h"
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

// A length is off by its rounding, and by that of the positions that it comes from: half a unit in the last place of
// each coordinate.
constexpr double kOfCoordinates = kUnit;
// The quotient of two lengths, in the same parts.
constexpr double kOfQuotient = 2 * std::numeric_limits<double>::epsilon();
// Errors count twice in the dilatation of a triangle, whose computation makes errors of that size.
constexpr double kOfDilatation = 2;

std::vector<double> errors_of_lengths(const Surface& surface) {
  const auto& points = surface.polygons.vertices;
  const auto size = [&](int v) { return std::hypot(points[v][0], points[v][1], points[v][2]); };
  std::vector<double> errors;
  for (std::size_t e = 0; e < surface.edges.size(); ++e) {
    const auto [a, b] = surface.edges[e];
    errors.push_back(mesh::length_error(surface) * surface.edge_lengths[e] +
                     (surface.intrinsic() ? 0 : kOfCoordinates * (size(a) + size(b))));
  }
  return errors;
}

class SimilaritySearch {
 public:
  SimilaritySearch(const Surface& a, const Surface& b, int sign, Execution& execution)
      : a_(a),
        b_(b),
        sign_(sign),
        execution_(execution),
        twins_a_(twins(a)),
        twins_b_(twins(b)),
        errors_a_(errors_of_lengths(a)),
        errors_b_(errors_of_lengths(b)) {
    steps_left_ = kMostWalks * static_cast<std::int64_t>(a.triangles.size());
  }

  std::optional<Similarity> run() {
    std::optional<Similarity> nearest;
    if (a_.triangles.size() != b_.triangles.size() || a_.edges.size() != b_.edges.size()) return nearest;
    const auto sum = [](const Surface& s) {
      return std::accumulate(s.edge_lengths.begin(), s.edge_lengths.end(), 0.0);
    };
    scale_ = sum(b_) / sum(a_);
    const auto longest = std::max_element(a_.edge_lengths.begin(), a_.edge_lengths.end()) - a_.edge_lengths.begin();
    const int from = side_of_edge(static_cast<int>(longest));
    for (int to = 0; to < static_cast<int>(twins_b_.size()) && steps_left_ > 0; ++to) {
      if (!walk(from, to)) continue;
      limit_ = largest_;  // those after it have to be nearer
      nearest = {largest_ + kOfDilatation * largest_error_, least_ <= most_};
      if (nearest->is_exact) break;
    }
    return nearest;
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
    std::array<mesh::RoundedLength, 3> a, b;
    const auto ratio = [&](int i) { return b[i].length / a[i].length; };
    for (int i = 0; i < 3; ++i) {
      const int side = next(from, i), image = next(to, sign_ * i);
      if ((twins_a_[side] < 0) != (twins_b_[image] < 0)) return false;
      a[i] = {length(a_, side), errors_a_[a_.triangle_edges[side / 3][side % 3]]};
      b[i] = {length(b_, image), errors_b_[b_.triangle_edges[image / 3][image % 3]]};
    }
    const bool are_same = ratio(1) == ratio(0) && ratio(2) == ratio(0);
    // A triangle without area has no dilatation; lengths in one ratio need none.
    const double dilatation = are_same ? 0 : this->dilatation(a, b), size = std::abs(std::log(ratio(0) / scale_));
    if (!(dilatation <= limit_ && size <= kSimilar)) return false;
    largest_ = std::max(largest_, dilatation);
    if (!are_same) largest_error_ = std::max(largest_error_, error(a) + error(b));
    for (int i = 0; i < 3; ++i) {
      const double part = a[i].error / a[i].length + b[i].error / b[i].length + kOfQuotient;
      least_ = std::max(least_, ratio(i) * (1 - part));
      most_ = std::min(most_, ratio(i) * (1 + part));
    }
    return true;
  }

  // How much the errors of its sides may change the dilatation of a triangle.
  static double error(const std::array<mesh::RoundedLength, 3>& sides) {
    const double growth = mesh::energy_growth(sides);
    return growth < 1 ? growth : kInfinity;
  }

  // log(s1 / s2) of the map between two triangles. With the first sides along the real axis it is [[s, p], [0, q]], and
  // s1/s2 + s2/s1 - 2 = ((s - q)^2 + p^2) / (s q), which has no cancellation.
  static double dilatation(const std::array<mesh::RoundedLength, 3>& a, const std::array<mesh::RoundedLength, 3>& b) {
    const auto apex = [](const std::array<mesh::RoundedLength, 3>& l) {
      const double x = l[0].length, y = l[1].length, z = l[2].length;
      return std::array{((z - y) * (z + y) / x + x) / 2, 2 * mesh::triangle_area(x, y, z) / x};
    };
    const auto from = apex(a), to = apex(b);
    const double s = b[0].length / a[0].length, q = to[1] / from[1], p = (to[0] - s * from[0]) / from[1];
    return 2 * std::asinh(std::sqrt(((s - q) * (s - q) + p * p) / (s * q)) / 2);
  }

  // Whether all triangles fit, from these sides on.
  bool walk(int from, int to) {
    std::vector<int> images(a_.triangles.size(), -1);  // side of b that is the image of side 0
    std::vector<char> is_image(b_.triangles.size(), 0);
    std::vector<int> queue;
    largest_ = largest_error_ = least_ = 0;
    most_ = kInfinity;
    const auto reach = [&](int side, int image) {
      int& known = images[side / 3];
      const int first = next(image, -sign_ * (side % 3));
      if (known >= 0) return known == first;
      if (is_image[image / 3] || !fits(side, image)) return false;
      known = first;
      is_image[image / 3] = 1;
      queue.push_back(side / 3);
      return true;
    };
    if (!reach(from, to)) return false;
    for (std::size_t i = 0; i < queue.size(); ++i) {
      execution_.step(i, a_.triangles.size());
      if (--steps_left_ < 0) return false;
      for (int k = 0; k < 3; ++k) {
        const int side = 3 * queue[i] + k, image = next(images[queue[i]], sign_ * k);
        if (twins_a_[side] >= 0 && !reach(twins_a_[side], twins_b_[image])) return false;
      }
    }
    return queue.size() == a_.triangles.size();  // @pre: connected
  }

  const Surface &a_, &b_;
  int sign_;
  Execution& execution_;
  std::vector<int> twins_a_, twins_b_;
  std::vector<double> errors_a_, errors_b_;
  std::int64_t steps_left_;
  double scale_ = 1, limit_ = kSimilar;
  // The walk so far: dilatation of lengths as they are, and by their errors; the factors that all lengths allow.
  double largest_ = 0, largest_error_ = 0, least_ = 0, most_ = 0;
};

}  // namespace

std::optional<Similarity> similarity(const Surface& a, const Surface& b, int sign, Execution& execution) {
  return SimilaritySearch(a, b, sign, execution).run();
}

}  // namespace holomorph::moduli
