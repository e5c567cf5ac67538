#include "progressive/independent_order.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace holomorph::progressive {
namespace {

// Larger stars wait: their vertex becomes a neighbour of many others, and they are slow to walk around.
constexpr int kLargestStar = 12;
// A round that removes less than this part of the vertices is not worth another one with the same rules.
constexpr double kLeastRemoved = 0.05;

class IndependentOrder {
 public:
  explicit IndependentOrder(EdgeCollapse& mesh) : mesh_(mesh) {
    for (int v = 0; v < mesh.vertex_count(); ++v) {
      if ((mesh.vertex(v).flags & Vertex::kRemoved) == 0) left_.push_back(v);
    }
  }

  /// One round; returns how many vertices were removed. Vertices that are left are in ascending order.
  std::size_t round(Geometry geometry) {
    for (const int v : left_) mesh_.vertex(v).flags &= ~Vertex::kTouched;
    for (std::size_t k = 0; k < left_.size(); ++k) {
      const int v = left_[k];
      if ((mesh_.vertex(v).flags & Vertex::kTouched) == 0) visit(v, geometry);
    }
    const std::size_t before = left_.size();
    std::erase_if(left_, [this](int v) { return (mesh_.vertex(v).flags & Vertex::kRemoved) != 0; });
    return before - left_.size();
  }

  std::size_t left() const { return left_.size(); }

 private:
  void visit(int v, Geometry geometry) {
    mesh_.gather(v);
    const int n = mesh_.neighbour_count();
    if (geometry == Geometry::checked && n > kLargestStar) return;
    if (n > static_cast<int>(costs_.size())) costs_.resize(2 * n);
    constexpr float kRefused = std::numeric_limits<float>::infinity();
    for (int i = 0; i < n; ++i) costs_[i] = mesh_.along_boundary(i) ? mesh_.squared_length(i) : kRefused;
    while (true) {
      const auto best = std::min_element(costs_.begin(), costs_.begin() + n);
      if (*best == kRefused) return;
      if (collapse(static_cast<int>(best - costs_.begin()), geometry)) return;
      *best = kRefused;
    }
  }

  bool collapse(int i, Geometry geometry) {
    if (!mesh_.keeps_topology(i) || (geometry == Geometry::checked && !mesh_.keeps_normals(i))) return false;
    mesh_.collapse(i);
    // The neighbours wait for the next round, so that vertices removed in one round are not adjacent.
    for (int k = 0; k < mesh_.neighbour_count(); ++k) mesh_.vertex(mesh_.neighbour(k)).flags |= Vertex::kTouched;
    return true;
  }

  EdgeCollapse& mesh_;
  std::vector<int> left_;
  std::vector<float> costs_ = std::vector<float>(64);
};

}  // namespace

void collapse_independent_sets(EdgeCollapse& mesh, Execution& execution) {
  mesh.reserve(mesh.vertex_count());
  IndependentOrder order(mesh);
  while (static_cast<double>(order.round(Geometry::checked)) > kLeastRemoved * static_cast<double>(order.left())) {
    execution.report(mesh.removed_fraction());
  }
  // Then without regard to normals and sizes of stars, until no collapse is left.
  while (order.round(Geometry::ignored) > 0) {
  }
}

}  // namespace holomorph::progressive
