// What vertices and faces are called in messages.
#pragma once

#include <string>
#include <vector>

namespace holomorph::mesh {

/// The number of an element in the mesh that the caller knows, of which this one may be a part.
class Labels {
 public:
  /// @param labels one for each element, which outlive this; empty: its own index
  explicit Labels(const std::vector<int>& labels) : labels_(labels) {}
  std::string operator()(int element) const { return std::to_string(labels_.empty() ? element : labels_[element]); }

 private:
  const std::vector<int>& labels_;
};

/// The labels of the vertices and of the faces of a mesh; by default their own indices.
struct MeshLabels {
  static inline const std::vector<int> kOwnIndices;
  Labels vertex{kOwnIndices}, face{kOwnIndices};
  bool is_part = false;  ///< of a mesh, in whose numbers they are
};

}  // namespace holomorph::mesh
