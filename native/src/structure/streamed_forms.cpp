#include "structure/streamed_forms.h"

#include <algorithm>

#include "forms/codifferential.h"
#include "forms/gram_matrices.h"
#include "structure/guarantee.h"
#include "structure/invariants.h"
#include "uv/balance.h"

namespace holomorph::structure {

void measure_in_blocks(const mesh::HalfEdges& triangulation, std::span<const double> weights,
                       std::span<const double> errors, HarmonicSystems& systems, topology::IntegerForms&& classes,
                       Structure& result, Execution& execution) {
  const int n = classes.form_count;
  const mesh::Surface& surface = *result.surface;
  Certificate& certificate = result.certificate;
  forms::ClosedForms solved{std::move(classes), {}}, on_surface{result.topology.classes, {}};
  Eigen::MatrixXd G(n, n);
  std::vector<Eigen::MatrixXd> uncertain;
  if (!errors.empty()) uncertain = {Eigen::MatrixXd::Zero(n, n)};
  const int blocks = (n + result.memory.block - 1) / result.memory.block;
  result.samples.triangles = uv::sample_triangles(surface);
  result.samples.on_sides.resize(2 * static_cast<Eigen::Index>(result.samples.triangles.size()), n);
  const auto measure = [&](int first, forms::RowMajorMatrix&& functions) {
    const auto width = functions.cols();
    solved.first = on_surface.first = first;
    solved.functions.swap(functions);
    G.middleCols(first, width) = forms::class_products(triangulation, weights, solved.classes, solved);
    // A positive matrix is at most the number of its diagonal blocks times these.
    if (!errors.empty()) {
      uncertain[0].block(first, first, width, width) =
          blocks *
          forms::gram_matrices(triangulation, errors, {}, solved, {static_cast<int>(width)}, execution)[0].value;
    }
    const auto [closedness, harmonicity] =
        forms::residuals(triangulation, weights, solved, execution, static_cast<int>(width), {});
    certificate.residuals.closedness = std::max(certificate.residuals.closedness, closedness);
    certificate.residuals.harmonicity = std::max(certificate.residuals.harmonicity, harmonicity);
    on_surface.functions.swap(solved.functions);
    certificate.periods =
        std::max(certificate.periods, forms::period_residual(surface, on_surface, result.topology.homology_basis));
    result.samples.on_sides.middleCols(first, width) =
        uv::values_on_sides(surface, mesh::Sides(surface), on_surface, result.samples.triangles);
  };
  systems.solve_in_blocks(solved.classes, n, result.memory.block, execution, measure);
  result.solver = systems.report();
  certificate.asymmetry = (G - G.transpose()).cwiseAbs().maxCoeff() / G.cwiseAbs().maxCoeff();
  result.gram = {(G + G.transpose()) / 2};
  result.certain_gram = certain_gram(result.gram, uncertain);
  set_holomorphic_basis(result);
}

}  // namespace holomorph::structure
