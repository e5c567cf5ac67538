#include "structure/harmonic_solver.h"

#include <algorithm>

#include "forms/laplacian.h"
#include "mesh/components.h"
#include "solver/solver_choice.h"

namespace holomorph::structure {

using mesh::DoubleCover;
using mesh::edge_of;
using mesh::HalfedgeHandle;
using topology::IntegerForms;

namespace {

std::unique_ptr<const DoubledSurface> doubled_where(Boundary boundary, const mesh::Discretisation& discretisation,
                                                    Execution& execution) {
  if (boundary == Boundary::natural) return nullptr;
  return std::make_unique<const DoubledSurface>(doubled(discretisation, execution));
}

// The vertices at which Dirichlet functions are 0. There are none on the double, which has no boundary.
std::vector<int> fixed_vertices(const DoubledSurface* on_double, const mesh::Discretisation& discretisation) {
  return on_double ? std::vector<int>() : mesh::boundary_vertices(discretisation.half_edges);
}

Extent extent_of(const mesh::Discretisation& discretisation, int forms) {
  return {static_cast<std::int64_t>(discretisation.half_edges.n_vertices()),
          static_cast<std::int64_t>(discretisation.weights.size()), forms};
}

std::vector<solver::Condition> conditions(int natural, int count) {
  std::vector<solver::Condition> result(count, solver::Condition::natural);
  std::fill(result.begin() + std::clamp(natural, 0, count), result.end(), solver::Condition::dirichlet);
  return result;
}

}  // namespace

DoubledSurface doubled(const mesh::Discretisation& surface, Execution& execution) {
  DoubledSurface result{mesh::double_cover(surface.half_edges, execution), {}};
  const auto& [half_edges, dual_vertex, first, second] = result.cover;
  result.weights.resize(half_edges.n_edges(), 0.0);
  for (int e = 0; e < static_cast<int>(surface.weights.size()); ++e) {
    // Copies are known by half-edges that have a face. Both copies of a boundary edge are one edge of the double, which
    // gets the weight twice: the cotangents of both its faces.
    const bool is_outside = surface.half_edges.is_boundary(HalfedgeHandle(2 * e));
    const int h = is_outside ? 2 * e + 1 : 2 * e;
    result.weights[edge_of(first[h])] += surface.weights[e];
    result.weights[edge_of(second[h])] += surface.weights[e];
  }
  return result;
}

IntegerForms extended(const mesh::HalfEdges& half_edges, const DoubleCover& cover, const IntegerForms& forms,
                      int natural) {
  static const IntegerForms::Row kZero;
  IntegerForms both;
  both.form_count = forms.form_count;
  both.rows.resize(cover.half_edges.n_edges());
  for (int i = 0; i < static_cast<int>(half_edges.n_halfedges()); ++i) {
    const HalfedgeHandle h(i);
    if (!half_edges.face_handle(h).is_valid()) continue;
    const HalfedgeHandle a = cover.first[i], b = cover.second[i];
    const auto& row = forms.rows[edge_of(h)];
    IntegerForms::Row dual = row;
    for (auto& [form, value] : dual) value = form < natural ? value : -value;
    // The second copy is written first, so that on a shared boundary edge the value of the first copy stays.
    both.rows.set(edge_of(b), topology::add(kZero, dual, mesh::sign(h) * mesh::sign(b)));
    both.rows.set(edge_of(a), topology::add(kZero, row, mesh::sign(h) * mesh::sign(a)));
  }
  return both;
}

forms::RowMajorMatrix symmetrised(const forms::RowMajorMatrix& f, const DoubleCover& cover, int natural) {
  const auto count = static_cast<Eigen::Index>(cover.dual_vertex.size());
  Eigen::RowVectorXd parity = Eigen::RowVectorXd::Constant(f.cols(), -1);
  parity.head(natural).setOnes();
  forms::RowMajorMatrix result(count, f.cols());
  for (Eigen::Index v = 0; v < count; ++v)
    result.row(v) = (f.row(v) + parity.cwiseProduct(f.row(cover.dual_vertex[v]))) / 2;
  return result;
}

HarmonicSolver::HarmonicSolver(const mesh::Discretisation& discretisation, MemoryPlan plan, Boundary boundary,
                               Execution& execution)
    : discretisation_(discretisation),
      plan_(std::move(plan)),
      double_(doubled_where(boundary, discretisation, execution)),
      systems_(half_edges(), weights(), fixed_vertices(double_.get(), discretisation), plan_.choice, execution) {}

HarmonicSolver::HarmonicSolver(const mesh::Discretisation& discretisation, MemoryPlan plan, Boundary boundary,
                               const MakeSolver& make, Execution& execution)
    : discretisation_(discretisation),
      plan_(std::move(plan)),
      double_(doubled_where(boundary, discretisation, execution)),
      systems_(half_edges(), weights(), fixed_vertices(double_.get(), discretisation), plan_.choice,
               make(forms::laplacian(half_edges(), weights(), execution)), execution.workers()) {}

HarmonicSolver::HarmonicSolver(const mesh::Discretisation& discretisation, int right_hand_sides, const Options& options,
                               Execution& execution)
    : HarmonicSolver(discretisation, plan_memory(extent_of(discretisation, right_hand_sides), options, Keeping::all),
                     Boundary::natural, execution) {}

void HarmonicSolver::solve_in_blocks(const topology::IntegerForms& classes, int natural, Execution& execution,
                                     const TakeFunctions& take) {
  const int count = classes.form_count;
  const auto both =
      double_ ? extended(discretisation_.half_edges, double_->cover, classes, natural) : topology::IntegerForms();
  const topology::IntegerForms& solved = double_ ? both : classes;
  for (int first = 0; first < count; first += plan_.block) {
    const int width = std::min(plan_.block, count - first);
    execution.part(static_cast<double>(first) / count, static_cast<double>(first + width) / count);
    // On the double all conditions are natural: antisymmetric functions vanish along the boundary by themselves.
    auto functions = systems_.solve(
        forms::codifferentials(half_edges(), weights(), solved, first, width, execution.workers()),
        conditions(double_ ? width : natural - first, width), [&] { return forms::class_terms(solved, first, width); },
        execution);
    if (double_) functions = symmetrised(functions, double_->cover, std::clamp(natural - first, 0, width));
    take(first, std::move(functions));
  }
}

forms::RowMajorMatrix HarmonicSolver::solve(const topology::IntegerForms& classes, int natural, Execution& execution) {
  const auto rows = static_cast<Eigen::Index>(discretisation_.half_edges.n_vertices());
  forms::RowMajorMatrix all(rows, 0);
  solve_in_blocks(classes, natural, execution, [&](int first, forms::RowMajorMatrix&& functions) {
    // A single block is handed over without a copy.
    if (functions.cols() == classes.form_count) {
      all = std::move(functions);
      return;
    }
    if (first == 0) all.resize(rows, classes.form_count);
    all.middleCols(first, functions.cols()) = functions;
  });
  return all;
}

LaplaceProblem laplace_problem(const mesh::Surface& surface, const std::vector<int>& fixed, const Options& options,
                               Execution& execution) {
  auto delaunay = mesh::on_delaunay(surface, mesh::half_edges(surface, execution), execution);
  const mesh::HalfEdges& half_edges = delaunay.half_edges;
  LaplaceProblem result;
  result.threads = execution.threads();
  result.weights = std::move(delaunay.weights);
  for (int e = 0; e < static_cast<int>(half_edges.n_edges()); ++e) {
    result.ends.push_back({mesh::to_vertex(half_edges, mesh::HalfedgeHandle(2 * e + 1)),
                           mesh::to_vertex(half_edges, mesh::HalfedgeHandle(2 * e))});
  }
  const auto choice = solver::choose_method(options.solver, surface.vertex_count, 1);
  result.solver =
      solver::make_solver(choice.method, forms::laplacian(half_edges, result.weights, execution), fixed, execution);
  return result;
}

}  // namespace holomorph::structure
