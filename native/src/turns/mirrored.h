// Turned tilings that mirror themselves as their surface does: one half is solved, whose rows end at the plane.
#pragma once

#include <memory>
#include <vector>

#include "mesh/mirror.h"
#include "mesh/surface.h"
#include "turns/turned_map.h"
#include "uv/direction.h"
#include "uv/uv_map.h"

namespace holomorph::turns {

/// Half of a surface that mirrors itself, and how maps of it become those of the whole.
class Half {
 public:
  /// The whole outlives this. @throws TopologyError for a surface that does not mirror itself, or whose half falls
  /// apart
  Half(const mesh::Surface& whole, uv::Up up, Execution& execution);

  const std::shared_ptr<const mesh::Surface>& surface() const { return surface_; }
  const std::vector<int>& lines() const { return lines_; }  ///< its edges in the plane

  /// Makes it a map of the whole, #C x 2 in coordinates of the square lattice. A row that ends at u = c in the plane
  /// goes on when it is moved by 2c, one that ends at v = c when it is turned by half as well. Cones are those of the
  /// half, twice, and those in the plane.
  TurnedMap unfolded(const TurnedMap& of_half, int turns) const;

 private:
  uv::UvArray unfolded(const uv::UvArray& uv) const;
  void add_cones_in_plane(int turns, TurnedMap& map) const;

  const mesh::Surface& whole_;
  mesh::Mirror mirror_;
  std::vector<int> corners_, vertices_;  // of the whole, of each corner and vertex of the half
  std::shared_ptr<const mesh::Surface> surface_;
  std::vector<int> lines_;
};

/// Finds the jumps of a map in coordinates of the square lattice, by edges. @param uv #C x 2
std::vector<Jump> jumps_of(const mesh::Surface& surface, const uv::UvArray& uv, int turns);

}  // namespace holomorph::turns
