// Where a surface is cut into islands: at hard edges and tips, until all are disks, and to cone points.
#pragma once

#include <array>
#include <vector>

#include "base/execution.h"
#include "mesh/surface.h"
#include "uv/uv_map.h"

namespace holomorph::flat {

// Islands of a surface, each flattened by itself.

struct Flattening {
  uv::UvArray uv;                     ///< #C x 2, each island about 0; 0 where it is not flat
  std::vector<double> scale_factors;  ///< #V length in the plane over that on the surface, 1 on the boundary
  std::vector<char> is_flat;          ///< #components, whether each was mapped
};

/// Maps each component that is a disk by flat::free_boundary_map. A component that is not a disk, or
/// for which a solver fails, is not flat.
/// @param surface cut open along its seams: its islands are its components
/// @throws Cancelled
/// Cost: one factorisation for each island.
Flattening flattened(const mesh::Surface& surface, Execution& execution);

/// Returns the UVs of flat islands, #C x 2. Islands that stretch are evened, and each has the area that it has on the
/// surface.
/// @param evenness from 0 to 1. @throws Cancelled
uv::UvArray evened(const mesh::Surface& surface, const Flattening& flattening, double evenness, Execution& execution);

/// The polygon sides of a surface, #C: each starts at a corner, its polygon on the left.
struct Sides {
  std::vector<int> edge, following;  ///< the edge, and the corner at the end
};

Sides sides_of(const mesh::Surface& surface);

/// The two polygon sides at one edge of the surface before it was cut open. Corners at the start and end of the one
/// side, then of the other; each side has its polygon on the left.
using Joint = std::array<int, 4>;

/// Where a surface is cut. Pieces have its polygons and corners; triangles at cuts may be others.
class Cuts {
 public:
  /// The hard edges, and on until all pieces are disks but for small holes. The surface outlives this.
  /// @param is_hard #E. @param to_tips whether cuts go from them to the tips
  Cuts(const mesh::Surface& surface, std::vector<char> is_hard, bool to_tips, Execution& execution);

  const std::vector<char>& is_cut() const { return is_cut_; }
  const Sides& sides() const { return sides_; }

  /// A surface of several components, more polygons at its end in small holes.
  mesh::Surface pieces(Execution& execution) const;

  /// Cuts these edges, too, #E. @return whether there were any
  bool add(const std::vector<char>& cuts);

  /// Paths from where pieces stretch most to their borders, #E, of those that change lengths by a larger factor.
  std::vector<char> to_cones(const mesh::Surface& pieces, const Flattening& flat, double most_stretch,
                             Execution& execution) const;

  /// The edges between the parts of pieces that lie over themselves, #E, each of which does not.
  std::vector<char> across_overlaps(const mesh::Surface& pieces, const uv::UvArray& uv, Execution& execution) const;

  /// One for each edge that is cut, in their order.
  std::vector<Joint> joints() const;

 private:
  std::vector<char> of_pieces(const mesh::Surface& pieces, const std::vector<char>& cuts) const;

  const mesh::Surface* surface_;
  Sides sides_;
  std::vector<char> is_cut_;
};

}  // namespace holomorph::flat
