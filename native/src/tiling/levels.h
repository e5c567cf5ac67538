// Levels of the progressive mesh of a surface, on which poles and cones are searched for.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "base/execution.h"
#include "mesh/surface.h"
#include "progressive/refinement.h"

namespace holomorph::tiling {

/// On a surface with more triangles, poles and turned maps are searched for on a level of about this many.
inline constexpr int kLevelTriangles = 10'000;
/// Cones are searched for on a level of so many first, and what a map could be is guessed there.
inline constexpr int kFewTriangles = 2000;

/// A level. Its vertices are vertices of the surface.
struct CoarseLevel {
  std::shared_ptr<const mesh::Surface> surface;
  std::vector<int> vertex;     ///< #V of the level: the same vertex of the surface
  std::vector<int> collapsed;  ///< #V of the surface: the vertex of the level that it was collapsed into
  /// The corners that are vertices of the level, for each polygon of the surface with more than four.
  std::vector<std::vector<int>> large_polygons = {};
  int splits = 0;  ///< vertex splits of the progressive mesh that lead to it

  /// Whether the level has all triangles of the surface.
  bool is_whole(const mesh::Surface& all) const { return surface->triangles.size() == all.triangles.size(); }
};

/// The levels of a surface. Vertices are numbered by their positions, so that levels do not depend on the surface's
/// numbers. A small surface keeps all its triangles. An intrinsic surface, or one without a progressive mesh, is its
/// only level. Several threads may use one.
class Levels {
 public:
  /// @param kept vertices of every level. @throws Cancelled
  Levels(std::shared_ptr<const mesh::Surface> surface, Execution& execution, std::vector<int> kept = {});

  /// The finest level with at most so many triangles. The vertices of a level are the first ones of each finer level
  /// that was simplified. @throws Cancelled
  CoarseLevel level(int triangles, Execution& execution) const;

  /// The progressive mesh of all triangles; null where there is none, or no level was asked for that needs it.
  const progressive::ProgressiveMesh* mesh() const { return mesh_ ? &*mesh_ : nullptr; }
  /// Whether it has the surface's own triangles: diagonals of polygons may have been flipped.
  bool has_triangles() const { return mesh_ && mesh_->triangle_corners.empty(); }
  const std::vector<int>& vertex() const { return vertex_; }      ///< its vertices on the surface
  const std::vector<int>& triangle() const { return triangle_; }  ///< its triangles there

 private:
  void simplify(Execution& execution) const;

  std::shared_ptr<const mesh::Surface> surface_, all_;  // all_: renumbered
  std::vector<int> kept_;
  std::vector<int> order_, triangle_order_;                   // of the vertices and triangles of all_
  mutable std::optional<progressive::ProgressiveMesh> mesh_;  // once it was needed
  mutable std::vector<int> vertex_, triangle_;
  mutable std::mutex one_at_a_time_;
};

}  // namespace holomorph::tiling
