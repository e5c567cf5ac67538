// How exposed a vertex is to views from outside. Poles and cones look best where they are hidden.
#pragma once

#include <array>
#include <optional>
#include <unordered_map>
#include <vector>

#include "base/workers.h"
#include "mesh/triangle_tree.h"

namespace holomorph::mesh {

/// The fraction of directions above a vertex, weighted by their cosine with the normal, that meet no triangle of the
/// surface. 1 on a convex surface, small in an armpit. Where it is known what is up, directions that point down count
/// less, since things stand on the ground: none from 30 degrees below the horizon on, all from 30 above it. The rays
/// are fixed, so it is deterministic. Rotating the surface changes it by some 0.05.
class AmbientOcclusion {
 public:
  /// @param up of length 1. @pre the surface has positions and outlives this
  explicit AmbientOcclusion(const Surface& surface, const std::optional<std::array<double, 3>>& up = {});

  /// Computes the exposure of these vertices. Cost: some hundred rays for each new one
  void prepare(const std::vector<int>& vertices, Workers& workers);
  /// @pre `prepare` was called for the vertex
  double operator()(int vertex) const { return known_.at(vertex); }

 private:
  double found(int vertex) const;

  const Surface& surface_;
  TriangleTree tree_;
  std::vector<Eigen::Vector3d> normals_;  // #V
  double begin_;                          // of the rays
  std::vector<double> weights_;           // of the rays
  std::unordered_map<int, double> known_;
};

}  // namespace holomorph::mesh
