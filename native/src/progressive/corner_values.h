// Values at polygon corners, such as UVs, of the original on coarser levels.
#pragma once

#include <span>
#include <vector>

#include "progressive/refinement.h"

namespace holomorph::progressive {

/// Values at the corners of one level.
struct CornerValues {
  std::vector<double> values;  ///< 3#T x width
  std::vector<int> corners;    ///< 3#T polygon corner of the original whose data each has
};

/// Corners of the original at the same vertex with the same values are one wedge (Hoppe 1996). The collapse of v_t into
/// v_s takes the wedges of v_t in the two triangles that vanish to those of v_s in the same triangles. A wedge of v_t
/// in neither of them lies beyond a cut through v_t that does not contain v_s. v_s has no value there, so the wedge is
/// translated by the same vector as the others.
///
/// For UVs that only jump by translations across their cuts, those of holomorphic forms, that vector is the same in all
/// wedges. Every vertex of a level keeps its UVs. Every edge has the difference of those of its ends along the
/// collapsed path. So a level's map has the periods of the original's, and jumps across the image of its cuts only.
///
/// Where UVs also turn across their cuts, the vector turns with them, from wedge to wedge: all the same holds. A cone
/// must not move.
///
/// @param values #C x width, one row for each polygon corner of the original; finite
/// @param splits the levels, from 0 to all splits each
/// @param turns k for each two columns, UVs that turn by 2 pi / k across cuts; none: all are only translated
/// @throws TopologyError where a cone is collapsed, which `kept` of progressive_mesh prevents
/// @return one entry for each level. Cost: O(#T width), apart from the logarithm of a large star.
std::vector<CornerValues> collapsed_corner_values(const ProgressiveMesh& mesh, const std::vector<double>& values,
                                                  int width, const std::vector<int>& splits,
                                                  const std::vector<int>& turns = {});

}  // namespace holomorph::progressive
