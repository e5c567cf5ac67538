// Where a surface breaks off: edges between faces that meet at an angle, and tips that only a cut can flatten.
#pragma once

#include <array>
#include <numbers>
#include <vector>

#include "base/constants.h"
#include "base/execution.h"
#include "mesh/surface.h"

namespace holomorph::mesh {

// Facets, the wide flat places of a surface. A bevel or a rounded edge between two of them is one hard edge, however
// little each of its own edges bends.

/// Radians by which the surface breaks off at each edge, #E: the bend of its two polygons, or the angle between the
/// facets to both sides, if that is more. Strips between facets are part of that to which they bend less: a bevel is
/// one line. @pre the surface has positions Source: ours; the limits were chosen on pictures of bevelled props beside
/// smooth and coarse meshes.
std::vector<double> breaks(const Surface& surface);

/// Radians that are missing around a tip, or too many.
inline constexpr double kTip = std::numbers::pi / 3;

inline constexpr double radians(double degrees) { return degrees * (std::numbers::pi / 180); }

/// The angle between two vectors, in radians, also where they are nearly parallel.
double angle_between(const std::array<double, 3>& a, const std::array<double, 3>& b);

/// Normals of the triangles, as long as twice their areas, #T.
std::vector<std::array<double, 3>> triangle_normals(const Surface& surface);

/// Unit normals of the polygons, by the mean of the triangles, #F. Slivers have that of the polygon to whose piece they
/// belong. @pre the surface has positions. Cost: O(#T)
std::vector<std::array<double, 3>> face_normals(const Surface& surface);

/// Radians by which these differ at each edge, #E; 0 for diagonals and on the boundary.
std::vector<double> bends(const Surface& surface);

/// How far a seam is seen along an edge where the surface breaks off by so many radians: from 1 across the smooth to 0,
/// hidden.
double seen(double breaks_off);

/// Cuts from the tips of the parts that these seams leave, along shortest paths to the seams or the boundary, #E.
/// @param is_seam #E. Cost: O(n log n)
std::vector<char> cuts_to_tips(const Surface& surface, const std::vector<char>& is_seam, Execution& execution);

/// The sum over the inner vertices of the angle that is missing around each, or too much, in radians. Vertices at one
/// place that edges join count as one.
/// @param is_seam #E edges whose vertices do not count; empty: none. @param most vertices where it is more do not, such
/// as `kTip`
double curvature(const Surface& surface, const std::vector<char>& is_seam, double most = kInfinity);

}  // namespace holomorph::mesh
