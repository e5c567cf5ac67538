#include "structure/harmonic_solver.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/errors.h"
#include "forms/laplacian.h"
#include "mesh/components.h"
#include "solver/direct/direct_solver.h"
#include "solver/solver_choice.h"

namespace holomorph::structure {

using mesh::DoubleCover;
using mesh::edge_of;
using mesh::HalfedgeHandle;
using topology::IntegerForms;

namespace {

// Bytes, as measured and rounded up: tests/core/structure/test_memory_limit.py holds the sum against the peak.
// Half-edges twice, lengths, weights, integer classes twice, fundamental domain, Laplacian, not all of them at the same
// time: per edge.
constexpr double kPerEdge = 150;
// The hierarchy of multigrid, and its vectors for 8 right-hand sides at once: per vertex.
constexpr double kMultigrid = 350;
// One right-hand side, its solution, and the solution as a row-major function: per vertex.
constexpr double kPerColumn = 24;
// The direct solver's own copies of a block of right-hand sides: per number.
constexpr double kDirectCopies = 6 * 8;
// Dense matrices of #forms x #forms that are there at once: of integers, the Gram matrix and its bounds, its
// projection.
constexpr double kDenseMatrices = 40;
// Blocks of the whole set of forms take this much where nothing is asked for.
constexpr double kDefaultBlock = 2.5e8;
// Multigrid runs on 8 right-hand sides at a time, on 4 or 2 where there are no more.
constexpr int kLanes = 8;

double solver_bytes(solver::Method method, const Extent& extent) {
  const auto n = static_cast<double>(extent.vertices);
  if (method == solver::Method::multigrid) return kMultigrid * n;
  const auto block = std::min<Eigen::Index>(solver::direct_block(extent.vertices), extent.forms);
  return solver::factor_bytes(n) + kDirectCopies * n * static_cast<double>(block);
}

// Everything but the forms.
double fixed_bytes(solver::Method method, const Extent& extent) {
  const auto forms = static_cast<double>(extent.forms);
  return kPerEdge * static_cast<double>(extent.edges) + solver_bytes(method, extent) +
         kDenseMatrices * 8 * forms * forms;
}

// The solver asked for, or the one that "auto" chooses: multigrid if the factor and `forms` bytes more do not fit.
solver::Choice choice_that_fits(const Extent& extent, const std::string& solver, double forms, std::int64_t limit) {
  auto choice = solver::choose_method(solver, extent.vertices, extent.forms);
  if (limit <= 0 || solver != "auto" || choice.method != solver::Method::direct) return choice;
  const double direct = fixed_bytes(choice.method, extent), other = fixed_bytes(solver::Method::multigrid, extent);
  if (direct + forms <= static_cast<double>(limit) || direct <= other) return choice;
  return {solver::Method::multigrid, "the factor would not fit into memory_limit"};
}

// The largest number of right-hand sides whose block fits into `bytes`: a multiple of 8, or 4 or 2.
int block_that_fits(double bytes, const Extent& extent) {
  const double columns = std::min(std::floor(bytes / (kPerColumn * static_cast<double>(extent.vertices))),
                                  static_cast<double>(extent.forms + kLanes - 1));
  const int most = static_cast<int>(std::max(columns, 0.0));
  if (most >= kLanes) return most - most % kLanes;
  return most >= 4 ? 4 : most >= 2 ? 2 : 0;
}

std::string in_bytes(double bytes) { return std::to_string(static_cast<std::int64_t>(std::ceil(bytes))) + " bytes"; }

// All right-hand sides, solutions and functions at once.
double forms_bytes(const Extent& extent) {
  return (8 + kPerColumn) * static_cast<double>(extent.vertices) * static_cast<double>(extent.forms);
}

// Beyond both, a computation without a limit is refused: a small mesh with thousands of loops.
constexpr double kMostBytes = 1e9, kMostPerVertex = 1e5;

std::string solving_for(const Extent& extent) {
  return "solving for " + std::to_string(extent.forms) + " forms on " + std::to_string(extent.vertices) + " vertices";
}

MemoryPlan checked(MemoryPlan plan, const Extent& extent, const Options& options) {
  const auto bytes = static_cast<double>(plan.bytes);
  if (options.memory_limit > 0 || bytes <= std::max(kMostBytes, kMostPerVertex * static_cast<double>(extent.vertices)))
    return plan;
  throw SolverError(solving_for(extent) + " may take " + std::to_string(plan.bytes) +
                    " bytes; set memory_limit to as many if they may be used");
}

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

MemoryPlan plan_memory(const Extent& extent, const Options& options, Keeping keeping) {
  const auto& [solver, memory_limit, boundary] = options;
  const auto n = static_cast<double>(extent.vertices);
  const double kept = 8 * n * static_cast<double>(extent.forms), column = kPerColumn * n;
  MemoryPlan plan;
  if (keeping == Keeping::all) {
    plan.choice = choice_that_fits(extent, solver, forms_bytes(extent), memory_limit);
    plan.block = static_cast<int>(extent.forms);
    plan.bytes = static_cast<std::int64_t>(fixed_bytes(plan.choice.method, extent) + forms_bytes(extent));
    require_memory(solving_for(extent), plan.bytes, memory_limit);
    return checked(std::move(plan), extent, options);
  }
  plan.choice = choice_that_fits(extent, solver, 2 * column, memory_limit);
  // A complex combination of forms is two right-hand sides.
  plan.map_choice = choice_that_fits({extent.vertices, extent.edges, 2}, solver, 2 * column, memory_limit);
  const double limit = static_cast<double>(memory_limit), fixed = fixed_bytes(plan.choice.method, extent);
  if (memory_limit <= 0) {
    plan.keep_forms = kept <= static_cast<double>(kKeptBytes);
    plan.block = std::max(kLanes, block_that_fits(kDefaultBlock, extent));
  } else {
    // Keeping all functions is worthwhile if a block of 8 still fits beside them.
    plan.keep_forms = fixed + kept + kLanes * column <= limit;
    plan.block = block_that_fits(std::min(limit - fixed - (plan.keep_forms ? kept : 0), kDefaultBlock), extent);
    if (plan.block == 0) {
      throw SolverError("memory_limit is " + std::to_string(memory_limit) + " bytes, but at least " +
                        in_bytes(fixed + 2 * column) + " are needed to solve for two of the " +
                        std::to_string(extent.forms) + " forms at a time on " + std::to_string(extent.vertices) +
                        " vertices");
    }
  }
  // If one block has all forms, its functions are the ones that are kept: they count once.
  const double others = plan.keep_forms && plan.block < extent.forms ? kept : 0;
  plan.bytes = static_cast<std::int64_t>(fixed + others + plan.block * column);
  return checked(std::move(plan), extent, options);
}

MemoryPlan plan_memory(const mesh::Surface& surface, const mesh::TopologicalType& type, const Options& options,
                       Keeping keeping) {
  Extent extent{surface.vertex_count, static_cast<std::int64_t>(surface.edges.size()), type.form_count()};
  if (type.closed()) return plan_memory(extent, options, keeping);
  extent.forms *= 2;
  if (options.boundary == Boundary::double_cover) {
    // The double shares the edges of the boundary, and as many vertices.
    const auto shared = std::count(surface.edge_face_count.begin(), surface.edge_face_count.end(), 1);
    extent.vertices = 2 * extent.vertices - shared;
    extent.edges = 2 * extent.edges - shared;
  }
  return plan_memory(extent, options, Keeping::all);
}

void require_memory(const std::string& what, std::int64_t bytes, std::int64_t memory_limit) {
  if (memory_limit <= 0 || bytes <= memory_limit) return;
  throw SolverError(what + " would take " + std::to_string(bytes) + " bytes; memory_limit is " +
                    std::to_string(memory_limit));
}

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
