// UVs from potentials.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <string>
#include <vector>

#include "base/errors.h"
#include "base/execution.h"
#include "base/workers.h"
#include "forms/closed_forms.h"
#include "topology/domain.h"
#include "topology/homology.h"

namespace holomorph {

/// @param rows real or complex, @param what the rows are of, e.g. "corner"
/// @throws SolverError naming the first row that is not finite. Cost: linear, in parallel.
template <class Derived>
void require_finite(const Eigen::DenseBase<Derived>& rows, const char* what, Workers& workers) {
  const int count = static_cast<int>(rows.rows());
  const int bad = first_row(workers, count, [&](int i) { return !rows.row(i).allFinite(); });
  if (bad == count) return;
  throw SolverError(std::string("the map has no finite coordinates at ") + what + " " + std::to_string(bad) +
                    ": the mesh is too degenerate there");
}

}  // namespace holomorph

namespace holomorph::uv {

// Integer potentials of the classes on the surface cut open along its cut graph (docs/method/uvs.md).

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

using UvArray = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>;

/// Computes UV(corner) = sum_k p_k (f_k(vertex) + P_k(corner)) for complex coefficients p of the harmonic basis. Across
/// each
/// cut the UV jump is a constant translation, an integer combination of the p_k.
/// @param functions #V x 2g, the f_k. @return #C x 2
UvArray uv_map(const mesh::Surface& surface, const CoveringSheets& sheets, const forms::RowMajorMatrix& functions,
               const Eigen::VectorXcd& p, Workers& workers);

/// Computes UV(corner) = at_vertex(vertex) + sum_k p_k P_k(corner), from any function at the vertices, #V x 2.
UvArray uv_map(const mesh::Surface& surface, const CoveringSheets& sheets, const UvArray& at_vertex,
               const Eigen::VectorXcd& p, Workers& workers);
/// Writes the same into given memory, #C x 2.
void write_uv_map(const mesh::Surface& surface, const CoveringSheets& sheets, const UvArray& at_vertex,
                  const Eigen::VectorXcd& p, Eigen::Ref<UvArray> uv, Workers& workers);

struct Frame {
  std::complex<double> low, high;  ///< corners of the bounding box, u + i v
  double area = 0;                 ///< sum of the absolute areas of the triangles
};

/// Computes the frame of the map rotated by an angle about 0. @param uv #C x 2. @param rotation radians,
/// counter-clockwise
/// The area is summed in a fixed order. Cost: O(#T).
Frame frame(const mesh::Surface& surface, const Eigen::Ref<const UvArray>& uv, double rotation, Workers& workers);

/// Maps z to factor (z - origin) + target: centred first, so that equal u or v of corners remain equal.
struct Placement {
  std::complex<double> factor, origin, target;
};

/// Writes the placed map into a larger array of corners.
/// @param uv #C x 2. @param rows #C row of `placed` of each corner, all different; null: row c of corner c
/// @param placed two numbers in each row
void place(const Eigen::Ref<const UvArray>& uv, const Placement& placement, const int* rows, double* placed,
           Workers& workers);

}  // namespace holomorph::uv
