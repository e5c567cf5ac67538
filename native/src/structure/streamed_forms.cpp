#include "structure/streamed_forms.h"

#include <algorithm>
#include <utility>

#include "forms/codifferential.h"
#include "forms/gram_matrices.h"

namespace holomorph::structure {

HarmonicForms streamed_forms(const mesh::Surface& surface, const Topology& topology, HarmonicSolver& solver,
                             const topology::IntegerForms& classes, Execution& execution) {
  const auto& [half_edges, lengths, weights, errors, metric_error, mollification, flips] = solver.discretisation();
  const int n = classes.form_count, block = solver.plan().block, blocks = (n + block - 1) / block;
  HarmonicForms result;
  Certificate& certificate = result.certificate;
  certificate.metric = metric_error;
  Eigen::MatrixXd G(n, n);
  std::vector<Eigen::MatrixXd> uncertain;
  if (!errors.empty()) uncertain = {Eigen::MatrixXd::Zero(n, n)};
  const mesh::Sides side(surface);
  auto& [triangles, on_sides] = result.samples;
  triangles = uv::sample_triangles(surface);
  on_sides.resize(2 * static_cast<Eigen::Index>(triangles.size()), n);
  const auto measure = [&](int first, forms::RowMajorMatrix&& functions) {
    const auto width = functions.cols();
    const forms::ClosedForms solved{classes, functions, first}, on_surface{topology.classes, functions, first};
    // <h_i, h_j> = <eta_i, h_j>, since h_j is coclosed: no other form has to be there (docs/method/harmonic.md).
    G.middleCols(first, width) = forms::class_products(half_edges, weights, classes, solved);
    // A positive matrix is at most the number of its diagonal blocks times the matrix of these blocks alone.
    if (!errors.empty()) {
      uncertain[0].block(first, first, width, width) =
          blocks * forms::gram_matrices(half_edges, errors, {}, solved, {static_cast<int>(width)}, execution)[0].value;
    }
    const auto [closedness, harmonicity] =
        forms::residuals(half_edges, weights, solved, execution, static_cast<int>(width), {});
    certificate.residuals.closedness = std::max(certificate.residuals.closedness, closedness);
    certificate.residuals.harmonicity = std::max(certificate.residuals.harmonicity, harmonicity);
    certificate.periods =
        std::max(certificate.periods, forms::period_residual(surface, on_surface, topology.homology_basis));
    on_sides.middleCols(first, width) = uv::values_on_sides(surface, side, on_surface, triangles);
  };
  solver.solve_in_blocks(classes, n, execution, measure);
  // G is symmetric if the systems are solved exactly. The difference shows their residuals.
  certificate.asymmetry = (G - G.transpose()).cwiseAbs().maxCoeff() / G.cwiseAbs().maxCoeff();
  result.invariants = invariants(topology, certain_gram({(G + G.transpose()) / 2}, uncertain));
  return result;
}

}  // namespace holomorph::structure
