// A tree of triangles, for rays and boxes that meet them.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "base/execution.h"
#include "base/workers.h"
#include "mesh/surface.h"

namespace holomorph::mesh {

/// Sorts the points' indices along a Z-order curve through their bounding cube (Morton 1966), so that near points are
/// near in the order. Points in one cell, of 2^-21 of the cube's side, keep the order of their numbers.
/// Cost: linear.
std::vector<int> spatial_order(const std::vector<std::array<double, 3>>& points);

class TriangleTree {
 public:
  /// @pre there are positions, which are copied, and a triangle. Cost: O(#T log #T)
  explicit TriangleTree(const Surface& surface) : TriangleTree(surface.polygons.vertices, surface.triangles) {}
  TriangleTree(std::span<const std::array<double, 3>> vertices, std::span<const Triple> triangles);

  /// Whether a ray, of any length, meets a triangle farther than `begin` times the direction from where it starts.
  bool meets(const Eigen::Vector3d& start, const Eigen::Vector3d& direction, double begin) const;

  /// Appends the triangles that may meet a box: those of leaves whose boxes do.
  void find_near(const Eigen::AlignedBox3d& box, std::vector<int>& found) const;

 private:
  struct Node {
    Eigen::AlignedBox3d box;
    int first, end;  // its triangles, as places in order_
  };
  using Corners = std::array<Eigen::Vector3d, 3>;

  void build(std::size_t node, int first, int end);

  std::vector<int> order_;        // triangles, near ones near each other
  std::vector<Corners> corners_;  // in that order
  std::vector<Node> nodes_;       // children of node n: 2 n + 1 and 2 n + 2
};

// Self-intersections of a mesh.

/// The pairs of triangles, the lower number first and in that order, of which a side of one goes through the other by
/// more than rounding. Two triangles that share a vertex can cross; two that share a side are skipped. Triangles that
/// only touch, or lie in one plane, do not cross.
/// Cost: O(#T log #T) and the pairs that are near each other, in parallel; the same at any number of threads.
std::vector<Pair> self_intersections(const std::vector<std::array<double, 3>>& vertices,
                                     const std::vector<Triple>& triangles, Execution& execution);

// How exposed a vertex is to views from outside. Poles and cones look best where they are hidden.

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
