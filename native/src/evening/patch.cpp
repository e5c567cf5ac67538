#include "evening/patch.h"

#include <algorithm>
#include <cmath>

namespace holomorph::evening {
namespace {

constexpr double kCollapsed = 1e-6;  // determinant of a map relative to its square: s1 / s2 is a million or more

bool any(const std::vector<char>& marked, const mesh::Triple& vertices) {
  return std::ranges::any_of(vertices, [&](int v) { return marked[v]; });
}

// Gives vertices the next number of the patch as they are asked for.
class Numbering {
 public:
  Numbering(int vertex_count, std::vector<int>& vertices) : number_(vertex_count, -1), vertices_(vertices) {}

  int operator()(int v) {
    if (number_[v] < 0) {
      number_[v] = static_cast<int>(vertices_.size());
      vertices_.push_back(v);
    }
    return number_[v];
  }

 private:
  std::vector<int> number_;
  std::vector<int>& vertices_;
};

}  // namespace

std::vector<char> StrainEnergy::near_flipped(const Function& delta, int rings) const {
  std::vector<char> inside(vertex_count(), 0);
  for (const Triangle& triangle : triangles_) {
    if (!(triangle.area > 0) || !flipped(triangle, derivatives(triangle, delta))) continue;
    for (const int v : triangle.vertices) inside[v] = 1;
  }
  // Each ring adds the triangles that touch those before.
  for (int ring = 0; ring < rings; ++ring) {
    const std::vector<char> before = inside;
    for (const Triangle& triangle : triangles_) {
      if (!any(before, triangle.vertices)) continue;
      for (const int v : triangle.vertices) inside[v] = 1;
    }
  }
  return inside;
}

// Gives the triangle the shape that it has under the map with these derivatives: from now on z is the coordinate in the
// plane of that map. A triangle that the map collapses has no shape to keep.
void StrainEnergy::Triangle::keep_shape(const Derivatives& map) {
  const double determinant = std::norm(map.a) - std::norm(map.b);
  if (!(std::abs(determinant) > kCollapsed * std::norm(map.a))) return;
  // The inverse of dw = a dz + b conj(dz), applied to the gradients and to the derivatives of the present map.
  for (Complex& g : gradients) g = (g * map.a - std::conj(g) * map.b) / determinant;
  const Complex a_before = a, b_before = b;
  a = (a_before * std::conj(map.a) - b_before * std::conj(map.b)) / determinant;
  b = (b_before * map.a - a_before * map.b) / determinant;
  keeps_shape = true;
  reversed = determinant < 0;
}

StrainEnergy::Patch StrainEnergy::around_flipped(const Function& delta, Rings rings) const {
  const std::vector<char> inside = near_flipped(delta, rings.all);
  const std::vector<char> inner =
      rings.inner > 0 ? near_flipped(delta, rings.inner) : std::vector<char>(vertex_count(), 0);
  Patch patch;
  Numbering number(vertex_count(), patch.vertices);
  for (int v = 0; v < vertex_count(); ++v) {
    if (inside[v]) number(v);
  }
  patch.free_count = static_cast<int>(patch.vertices.size());
  patch.energy.log_size_ = log_size_;
  patch.energy.whole_area_ = whole_area_;
  for (Triangle triangle : triangles_) {
    if (!any(inside, triangle.vertices)) continue;
    const Derivatives before{triangle.a, triangle.b}, map = derivatives(triangle, delta);
    // delta becomes part of the map, so that the patch begins with the function 0.
    triangle.a = map.a;
    triangle.b = map.b;
    const bool is_inner = std::ranges::all_of(triangle.vertices, [&](int v) { return inner[v]; });
    if (is_inner && !triangle.at_pole) triangle.keep_shape(before);
    for (int& v : triangle.vertices) v = number(v);
    patch.energy.triangles_.push_back(triangle);
  }
  patch.energy.find_stars(static_cast<int>(patch.vertices.size()));
  return patch;
}

}  // namespace holomorph::evening
