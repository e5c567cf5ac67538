// What vertices are called in messages.
#pragma once

#include <string>
#include <vector>

namespace holomorph::mesh {

/// The number of a vertex in the surface that the caller knows, of which this one may be a component.
class VertexLabels {
 public:
  /// @param labels #V, which outlive this; empty: each vertex's own index
  explicit VertexLabels(const std::vector<int>& labels) : labels_(labels) {}
  std::string operator()(int vertex) const { return std::to_string(labels_.empty() ? vertex : labels_[vertex]); }

 private:
  const std::vector<int>& labels_;
};

}  // namespace holomorph::mesh
