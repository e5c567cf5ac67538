#include "flat/rectangle.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "flat/dirichlet_problem.h"
#include "flat/rectangle_corners.h"
#include "forms/certain_bounds.h"
#include "mesh/components.h"
#include "mesh/delaunay.h"
#include "mesh/half_edges.h"
#include "structure/certified_forms.h"
#include "uv/uv_map.h"

namespace holomorph::flat {
namespace {

// u: 0 on side 3, 1 on side 1; v: 0 on side 0, 1 on side 2. Each has conditions, and so a system, of its own.
struct Coordinates {
  DirichletSolution u, v;
  double harmonicity() const { return std::max(u.harmonicity, v.harmonicity); }
};

Coordinates coordinates(const mesh::Discretisation& discretisation, const Sides& sides, const Options& options,
                        double from, double to, Execution& execution) {
  const auto& [half_edges, lengths, weights, errors, metric_error, mollification, flips] = discretisation;
  const auto one = [&](int zero_side, int one_side) {
    std::vector<int> fixed = sides[zero_side];
    fixed.insert(fixed.end(), sides[one_side].begin(), sides[one_side].end());
    Eigen::MatrixXd f = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(half_edges.n_vertices()), 1);
    for (const int v : sides[one_side]) f(v, 0) = 1;
    return solve_dirichlet(discretisation, fixed, f, options, execution);
  };
  execution.stage("width", from, (from + to) / 2);
  Coordinates result{one(3, 1), {}};
  execution.stage("height", (from + to) / 2, to);
  result.v = one(0, 2);
  return result;
}

// Energies of u and of v that are certainly not below those of the surface, 1 x 1 each.
std::vector<Eigen::MatrixXd> certain_energies(const mesh::Discretisation& discretisation,
                                              const Coordinates& coordinates, Execution& execution) {
  topology::IntegerForms no_classes;
  no_classes.rows.resize(discretisation.weights.size());
  std::vector<Eigen::MatrixXd> result;
  for (const DirichletSolution* f : {&coordinates.u, &coordinates.v}) {
    const forms::RowMajorMatrix functions = f->functions;
    result.push_back(structure::certain_energies(discretisation, {no_classes, functions}, {1}, execution).certain[0]);
  }
  return result;
}

}  // namespace

PlaneMap rectangle_map(const mesh::Surface& surface, const std::vector<int>& corners, const std::vector<int>& labels,
                       const Options& options, Execution& execution) {
  PlaneMap result;
  execution.stage("half-edges", 0.0, 0.1);
  auto half_edges = mesh::half_edges(surface, execution);
  const Sides sides = rectangle_sides(surface, half_edges, corners, labels);
  result.corners = corners;
  result.collapsed_triangles = collapsed_triangles(surface, sides);

  execution.stage("intrinsic Delaunay", 0.1, 0.2);
  const auto delaunay = mesh::on_delaunay(surface, half_edges.copy(execution.workers()), execution);
  result.flip_count = static_cast<int>(delaunay.flips.size());
  result.mollification = delaunay.mollification;
  const bool flipped = result.flip_count > 0;
  const Coordinates sharp = coordinates(delaunay, sides, options, 0.2, flipped ? 0.6 : 1.0, execution);
  const auto certain = certain_energies(delaunay, sharp, execution);
  // The geometric mean of the bounds 1 / E(v) and E(u).
  result.modulus = std::sqrt(sharp.u.energies[0] * (1 / sharp.v.energies[0]));
  result.metric = delaunay.metric_error;
  // 1 / E(v) <= m <= E(u) by Dirichlet's principle: u is admissible for the modulus, and v for its inverse.
  const Eigen::MatrixXd lower = forms::below_inverse(certain[1]);
  if (result.mollification == 0) structure::require_ordered(lower, certain[0]);
  result.lower = lower(0, 0);
  result.upper = certain[0](0, 0);

  // Invariants come from the Delaunay triangulation, points from the triangles that are drawn (docs/method/surface.md).
  const Coordinates drawn = flipped ? coordinates(mesh::on_input(surface, std::move(half_edges), execution), sides,
                                                  options, 0.6, 1.0, execution)
                                    : sharp;
  result.points.resize(surface.vertex_count);
  result.points.real() = drawn.u.functions.col(0);
  result.points.imag() = result.modulus * drawn.v.functions.col(0);
  require_finite(result.points, "vertex", execution.workers());
  result.harmonicity = std::max(sharp.harmonicity(), drawn.harmonicity());
  result.solver = sharp.v.solver.residual > sharp.u.solver.residual ? sharp.v.solver : sharp.u.solver;
  execution.finish();
  result.seconds = execution.seconds();
  return result;
}

}  // namespace holomorph::flat
