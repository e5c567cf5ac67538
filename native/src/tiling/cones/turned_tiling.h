// Tilings whose sides of a cut may also turn, by the symmetry of the texture: cones take the place of poles.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "base/errors.h"
#include "mesh/mirror.h"
#include "mesh/surface.h"
#include "tiling/cones/turned_map.h"
#include "uv/direction.h"
#include "uv/quality.h"
#include "uv/uv_map.h"

namespace holomorph::tiling {

/// Half of a surface that mirrors itself, and how maps of it become those of the whole: one half is solved, whose rows
/// end at the plane.
class Half {
 public:
  /// The whole outlives this. @throws TopologyError for a surface that does not mirror itself, or whose half falls
  /// apart
  Half(const mesh::Surface& whole, uv::Up up, Execution& execution);

  const std::shared_ptr<const mesh::Surface>& surface() const { return surface_; }
  const std::vector<int>& lines() const { return lines_; }  ///< its edges in the plane

  /// Makes it a map of the whole, with the square lattice. A row that ends at u = c in the plane
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

/// Which rows are lines: none; those along hard edges and smooth boundaries, which end there as well (whole) or lie
/// anywhere across them (free); those in the plane between two halves that are alike.
enum class Rows { kNone, kWhole, kFree, kMirror };

struct TilerOptions {
  int turns = 4;  ///< 2, 4 or 6: the texture looks the same after a half, a quarter or a sixth turn
  /// Along which u runs, or what is up for rows that run level, as far as they can; none: any direction
  std::optional<Along> along;
  uv::Up up = uv::Up::kZ;
  Rows rows = Rows::kNone;
  std::vector<mesh::Pair> marked;  ///< vertices of edges that are lines besides those that are found
  std::vector<int> chosen;         ///< #V, k-th turns that are missing around cones; empty where these are searched for
  std::shared_ptr<const Levels> levels = nullptr;  ///< of the surface; null: its own
};

struct TurnedTiling {
  TurnedMap map;  ///< the unit square is one tile, of the hexagonal lattice for sixth turns
  Rows rows = Rows::kNone;
  uv::Quality quality;
  /// Before the map is evened it is conformal, but for its whole numbers and the size of triangles. The mean, then,
  /// over the area of s1 / s2, at most 10 and of flipped triangles 10, and the root mean square of the Beltrami
  /// coefficient, at most 1 and of flipped triangles 1.
  double added_distortion = 1, beltrami_rms = 0;
};

/// Makes turned tilings of a surface. Their cones are searched for by the first one, and kept for others with about as
/// many tiles.
class TurnedTiler {
 public:
  /// @pre connected. @throws TopologyError for a surface without positions, for cones that it cannot have, and for one
  /// that should mirror itself and does not
  TurnedTiler(std::shared_ptr<const mesh::Surface> surface, const TilerOptions& options, Execution& execution);

  /// The number of tiles that suits the genus.
  double usual_tiles() const { return usual_tiles_; }

  /// See TurnedMaps.
  double guess(double tiles, Execution& execution) { return held(maps_).guess(tiles / (half_ ? 2 : 1), execution); }

  /// @throws TopologyError where most of the surface would collapse; SolverError; Cancelled
  TurnedTiling tile(double tiles, double evenness, Execution& execution);

 private:
  std::shared_ptr<const mesh::Surface> surface_;
  TilerOptions options_;
  double usual_tiles_;
  std::optional<Half> half_;
  std::optional<TurnedMaps> maps_;
};

/// The edges that lines of the lattice run along, ascending: long chains of hard edges, and smooth boundaries. None of
/// these where chains end here and there: that is noise of a scan, or folds.
/// @param marked vertices of edges that are lines in any case, unless they are most of the mesh's
std::vector<int> found_lines(const mesh::Surface& surface, const std::vector<mesh::Pair>& marked);

/// Whether few chains end, of edges with these vertices.
bool are_whole(const std::vector<mesh::Pair>& ends);

}  // namespace holomorph::tiling
