// The pieces of a surface between its hard edges. Windows in tubes, such as where a handle is fixed, are closed.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "base/execution.h"
#include "mesh/components.h"
#include "mesh/surface.h"
#include "uv/uv_map.h"

namespace holomorph::flat {

inline constexpr int kRest = -1;  ///< the name of polygons that are looked at with others

/// Names the piece of each polygon, #F, from 0 on: hard edges that end within one do not divide it. Those of little
/// area are `kRest`. All are 0 where but for a speck there is one. @param is_hard #E
std::vector<int> names_of_pieces(const mesh::Surface& surface, const std::vector<char>& is_hard);

/// The components of a surface that is cut between polygons of different names, with indices of its own vertices,
/// polygons and corners. @param names #F
std::vector<mesh::Component> cut_apart(const mesh::Surface& surface, const std::vector<int>& names,
                                       Execution& execution);

/// The same of a surface that is cut open between its tips where few see it: one component, unless the cut joins places
/// of its boundary. @param up see mesh/hidden_cut.h
struct CutInHiding {
  std::vector<mesh::Component> parts;
  double seen = 0;  ///< how far the cut is
};
CutInHiding cut_in_hiding(const mesh::Surface& surface, const std::optional<std::array<double, 3>>& up,
                          Execution& execution);

/// Fills all boundary loops but the two longest with a polygon each, appended at the end, longer ones first. Vertices,
/// polygons and corners keep their numbers.
/// @throws InvalidMesh where a window is not a polygon
mesh::Surface without_windows(const mesh::Surface& surface, Execution& execution);

/// Radians by which rows of squares of one map turn against those of another, in the mean over its area.
/// @param one, other #C x 2
double turn_between(const mesh::Surface& surface, const uv::UvArray& one, const uv::UvArray& other);

}  // namespace holomorph::flat
