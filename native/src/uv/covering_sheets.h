// Integer potentials of the classes on the surface cut open along its cut graph (docs/method/uvs.md).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/execution.h"
#include "topology/domain.h"
#include "topology/integer_forms.h"

namespace holomorph::uv {

/// On the fundamental domain every class eta_j has an integer potential P_j, found once by a walk over the faces. Few
/// of the vectors (P_1 .. P_2g) are different: each is kept once, as a sheet, and corners name their sheet.
struct CoveringSheets {
  Array<int> corner_sheet;                          ///< #C sheet of each polygon corner
  std::vector<topology::IntegerForms::Row> sheets;  ///< sparse vectors P of each sheet; sheet 0 is 0
};

/// @pre D has all diagonals inside, so that all triangles of a polygon lie on one sheet at each of its corners.
CoveringSheets corner_sheets(const mesh::Surface& surface, const mesh::HalfEdges& half_edges,
                             const topology::FundamentalDomain& domain, const topology::IntegerForms& classes,
                             Execution& execution);

/// Computes the same for a given cut: potentials on the pieces of the surface cut along the edges of `cut`, each with
/// the sheet
/// 0 at its first corner.
/// @param cut polygon edges; boundary edges do not matter
/// @param labels #V number of each vertex in messages; empty: its index
/// @throws TopologyError if a class has a period in a piece, naming an edge where its potential jumps
CoveringSheets corner_sheets(const mesh::Surface& surface, const mesh::HalfEdges& half_edges,
                             const std::vector<int>& cut, const topology::IntegerForms& classes, Execution& execution,
                             const std::vector<int>& labels = {});

}  // namespace holomorph::uv
