#include "evening/patch.h"

#include <algorithm>

namespace holomorph::evening {
namespace {

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
    if (!(triangle.area > 0) || !derivatives(triangle, delta).flipped()) continue;
    for (const int v : triangle.vertices) inside[v] = 1;
  }
  for (int ring = 0; ring < rings; ++ring) {
    const std::vector<char> before = inside;
    for (const Triangle& triangle : triangles_) {
      if (!any(before, triangle.vertices)) continue;
      for (const int v : triangle.vertices) inside[v] = 1;
    }
  }
  return inside;
}

StrainEnergy::Patch StrainEnergy::around_flipped(const Function& delta, int rings) const {
  const std::vector<char> inside = near_flipped(delta, rings);
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
    const Derivatives map = derivatives(triangle, delta);
    triangle.a = map.a;
    triangle.b = map.b;
    for (int& v : triangle.vertices) v = number(v);
    patch.energy.triangles_.push_back(triangle);
  }
  patch.energy.find_stars(static_cast<int>(patch.vertices.size()));
  return patch;
}

}  // namespace holomorph::evening
