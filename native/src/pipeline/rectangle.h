// The conformal map of a disk with four corners to a rectangle, and its modulus with bounds.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mesh/boundary_loops.h"
#include "pipeline/harmonic_forms.h"

namespace holomorph::pipeline {

/// Corners c0 .. c3 on the boundary, the surface on its left. u is 0 on the side from c3 to c0 and 1 on that from c1 to
/// c2, v is 0 from c0 to c1 and 1 from c2 to c3; the other sides are natural. Each has the least energy under its own
/// conditions, so (u, m v) is the conformal map to a rectangle of width 1 and height m up to the discretisation, and
/// its sides are straight exactly.
///
/// 1 / E(v) <= m <= E(u), E(f) = f . L f: both are energies of admissible functions of the polyhedral surface, on its
/// intrinsic Delaunay triangulation. The modulus is their geometric mean.
struct RectangleMap {
  std::array<int, 4> corners;
  Eigen::VectorXd u, v;  ///< #V, on the artist's triangulation
  double modulus = 0, lower = 0, upper = 0;
  std::vector<int> collapsed_triangles;  ///< triangles all of whose corners lie on one side
  double harmonicity = 0;                ///< largest |L f| at a free vertex over the largest sum of its terms
  double mollification = 0;
  int flip_count = 0;
  SolverReport solver;
  std::vector<std::pair<std::string, double>> seconds;
};

/// @param corners four vertices
/// @param names what a vertex is called in messages; empty: its index
/// @throws TopologyError for a surface that is no disk, corners that are repeated, out of range, not on the boundary or
/// not in its order; SolverError; Cancelled
/// Cost: four solves, of four matrices; two where no edge is turned.
RectangleMap rectangle_map(const mesh::Surface& surface, const std::vector<int>& corners, const std::vector<int>& names,
                           const Options& options, Execution& execution);

/// The four corners of a disk whose boundary has exactly four vertices at which it turns by more than 45 degrees, all
/// of them inwards, in its order from the lowest; nothing for other disks.
std::optional<std::vector<int>> clear_corners(const mesh::Surface& surface);

/// Number of edges of the longest boundary loop.
int boundary_length(const mesh::Surface& surface);

/// Four corners of a disk that has no clear ones: from the lowest boundary vertex on, those nearest to the quarters of
/// the boundary's length.
/// @throws TopologyError for a boundary of three edges
std::vector<int> quarter_corners(const mesh::Surface& surface);

}  // namespace holomorph::pipeline
