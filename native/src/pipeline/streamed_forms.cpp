#include "pipeline/streamed_forms.h"

#include <algorithm>

namespace holomorph::pipeline {

StreamedForms streamed_forms(const mesh::Surface& surface, const std::vector<std::vector<mesh::HalfedgeHandle>>& loops,
                             forms::ClosedForms& artist, const mesh::HalfEdges& triangulation,
                             std::span<const double> weights, solver::LaplaceSolver& solver,
                             forms::ClosedForms& intrinsic, const MemoryPlan& plan, Execution& execution) {
  const int n = intrinsic.classes.form_count;
  StreamedForms result;
  Eigen::MatrixXd G(n, n);
  result.samples.triangles = uv::sample_triangles(surface);
  result.samples.on_sides.resize(2 * static_cast<Eigen::Index>(result.samples.triangles.size()), n);
  Execution silent;
  const auto measure = [&](int first, forms::RowMajorMatrix&& functions) {
    const auto width = functions.cols();
    intrinsic.first = artist.first = first;
    intrinsic.functions.swap(functions);
    G.middleCols(first, width) = forms::class_products(triangulation, weights, intrinsic);
    const auto residuals = forms::residuals(triangulation, weights, intrinsic, silent);
    result.residuals.closedness = std::max(result.residuals.closedness, residuals.closedness);
    result.residuals.harmonicity = std::max(result.residuals.harmonicity, residuals.harmonicity);
    artist.functions.swap(intrinsic.functions);
    result.period_residual = std::max(result.period_residual, period_residual(surface, artist, loops));
    result.samples.on_sides.middleCols(first, width) = uv::values_on_sides(surface, artist, result.samples.triangles);
    artist.functions.swap(intrinsic.functions);
  };
  result.solver = solve_in_blocks(triangulation, weights, solver, intrinsic.classes, plan, execution, measure);
  intrinsic.functions.resize(0, 0);
  intrinsic.first = artist.first = 0;
  result.asymmetry = (G - G.transpose()).cwiseAbs().maxCoeff() / G.cwiseAbs().maxCoeff();
  result.gram_matrix = (G + G.transpose()) / 2;
  return result;
}

double period_residual(const mesh::EdgeEnds& ends, const forms::ClosedForms& forms,
                       const std::vector<std::vector<mesh::HalfedgeHandle>>& loops) {
  Eigen::MatrixXd periods = forms::periods(ends, forms, loops);
  for (Eigen::Index j = 0; j < periods.cols(); ++j) periods(forms.first + j, j) -= 1;
  return periods.cwiseAbs().maxCoeff();
}

}  // namespace holomorph::pipeline
