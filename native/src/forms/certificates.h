// Residuals and wedge products of harmonic forms, and their energies on the surface's own triangles, summed in a fixed
// order.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "base/execution.h"
#include "forms/closed_forms.h"
#include "mesh/half_edges.h"

namespace holomorph::forms {

/// Computes <h_i, h_i> on the surface's own triangles: the diagonal of the Gram matrix there, summed by triangles.
/// @pre no triangle is degenerate. Cost: #T x #forms
Eigen::VectorXd energies(const mesh::Surface& surface, const ClosedForms& forms, Execution& execution);

/// Relative maxima over all forms: |sum of a form around a face| over its largest value; |d* h| at a vertex over the
/// largest sum of |k h| at a vertex.
struct Residuals {
  double closedness = 0, harmonicity = 0;
};

/// @param fixed vertices at which d* h is measured for the first `natural` forms only: the others are prescribed there
Residuals residuals(const mesh::HalfEdges& half_edges, std::span<const double> weights, const ClosedForms& forms,
                    Execution& execution, int natural, const std::vector<int>& fixed);

/// Computes int h_i ^ w over the surface, for all forms h_i and one form w, #E values along half-edge 2e.
Eigen::VectorXd wedges(const mesh::HalfEdges& half_edges, const ClosedForms& forms, const Eigen::VectorXd& w,
                       Execution& execution);

}  // namespace holomorph::forms
