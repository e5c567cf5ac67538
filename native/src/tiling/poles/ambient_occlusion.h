// How exposed a vertex is to views from outside. Poles look best where they are hidden.
#pragma once

#include <unordered_map>
#include <vector>

#include "base/workers.h"
#include "mesh/triangle_tree.h"

namespace holomorph::tiling {

/// The fraction of directions above a vertex, weighted by their cosine with the normal, that meet no triangle of the
/// surface. 1 on a convex surface, small in an armpit. The rays are fixed, so it is deterministic. Rotating the surface
/// changes it by some 0.05.
class AmbientOcclusion {
 public:
  /// @pre the surface has positions and outlives this
  explicit AmbientOcclusion(const mesh::Surface& surface);

  /// Computes the exposure of these vertices. Cost: some hundred rays for each new one
  void prepare(const std::vector<int>& vertices, Workers& workers);
  /// @pre `prepare` was called for the vertex
  double operator()(int vertex) const { return known_.at(vertex); }

 private:
  double found(int vertex) const;

  const mesh::Surface& surface_;
  mesh::TriangleTree tree_;
  std::vector<Eigen::Vector3d> normals_;  // #V
  double begin_;                          // of the rays
  std::unordered_map<int, double> known_;
};

}  // namespace holomorph::tiling
