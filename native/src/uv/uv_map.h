// UVs from potentials.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/workers.h"
#include "forms/closed_forms.h"
#include "uv/corner_sheets.h"

namespace holomorph::uv {

using UvArray = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>;

/// Computes UV(corner) = sum_k p_k (f_k(vertex) + P_k(corner)) for complex coefficients p of the harmonic basis. Across
/// each
/// cut the UV jump is a constant translation, an integer combination of the p_k.
/// @param functions #V x 2g, the f_k. @return #C x 2
UvArray uv_map(const mesh::Surface& surface, const CornerSheets& sheets, const forms::RowMajorMatrix& functions,
               const Eigen::VectorXcd& p, Workers& workers);

/// Computes UV(corner) = at_vertex(vertex) + sum_k p_k P_k(corner), from any function at the vertices, #V x 2.
UvArray uv_map(const mesh::Surface& surface, const CornerSheets& sheets, const UvArray& at_vertex,
               const Eigen::VectorXcd& p, Workers& workers);
/// Writes the same into given memory, #C x 2.
void write_uv_map(const mesh::Surface& surface, const CornerSheets& sheets, const UvArray& at_vertex,
                  const Eigen::VectorXcd& p, Eigen::Ref<UvArray> uv, Workers& workers);

}  // namespace holomorph::uv
