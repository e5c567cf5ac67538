// Closed one-forms eta_i + d f_i: their values, combinations and periods.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mesh/edge_ends.h"
#include "topology/integer_forms.h"

namespace holomorph::forms {

using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// A family of closed forms eta_i + d f_i as a view of classes and functions: #forms numbers per vertex instead of per
/// edge. Where memory is short, only a block of the functions is present at a time, and #forms below counts those.
/// @pre classes and functions outlive this
struct ClosedForms {
  const topology::IntegerForms& classes;
  const RowMajorMatrix& functions;  ///< #V x #forms, for the classes first, first + 1, ...
  int first = 0;
};

/// Returns the values of all forms on the edges begin .. end-1, (end - begin) x #forms, along half-edge 2e.
RowMajorMatrix edge_values(const mesh::EdgeEnds& ends, const ClosedForms& forms, int begin, int end);

/// Writes the values of all forms on all edges, #forms x #E.
void write_edge_values(const mesh::EdgeEnds& ends, const ClosedForms& forms, Eigen::Ref<RowMajorMatrix> rows);

/// Returns the values of one combination sum_j c_j h_j on all edges, #E along half-edge 2e.
Eigen::VectorXd combination(const mesh::EdgeEnds& ends, const ClosedForms& forms, const Eigen::VectorXd& c);

/// Integrates the forms over closed loops of half-edges, #loops x #forms.
Eigen::MatrixXd periods(const mesh::EdgeEnds& ends, const ClosedForms& forms,
                        const std::vector<std::vector<mesh::HalfedgeHandle>>& loops);

/// Returns the largest |int_{loop i} h_j - delta_ij| over the first #loops classes, as far as their functions are
/// present.
double period_residual(const mesh::EdgeEnds& ends, const ClosedForms& forms,
                       const std::vector<std::vector<mesh::HalfedgeHandle>>& loops);

}  // namespace holomorph::forms
