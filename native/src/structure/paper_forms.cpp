#include "structure/paper_forms.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <set>
#include <span>
#include <string>
#include <utility>

#include "base/errors.h"
#include "forms/refined_solver.h"
#include "mesh/components.h"
#include "mesh/delaunay.h"
#include "solver/solver_choice.h"
#include "structure/conformal_structure.h"

namespace holomorph::structure {
namespace {

// The two sides of an edge may differ by this fraction of the largest coordinate: UVs are often kept in single
// precision, which rounds each coordinate by 6e-8 of itself.
constexpr double kSameVector = 1e-6;

void check_topology(const mesh::Surface& surface) {
  const auto type = mesh::topological_type(surface);
  if (surface.component_count == 1 && type.form_count() > 0) return;
  const std::string found =
      surface.component_count == 1 ? type.text() : std::to_string(surface.component_count) + " components";
  throw TopologyError("the surface has " + found +
                      "; a harmonic map of the same periods needs one surface with handles or two boundaries");
}

// The columns of v must not change along the boundary.
void check_boundary(const mesh::Surface& surface, const forms::RowMajorMatrix& edge_values, double tolerance) {
  for (std::size_t e = 0; e < surface.edges.size(); ++e) {
    if (surface.edge_face_count[e] > 1) continue;
    for (Eigen::Index k = 1; k < edge_values.cols(); k += 2) {
      if (std::abs(edge_values(static_cast<Eigen::Index>(e), k)) <= tolerance) continue;
      throw InvalidMesh("v changes along the boundary edge between vertices " + std::to_string(surface.edges[e][0]) +
                        " and " + std::to_string(surface.edges[e][1]) +
                        " of the level; only maps with straight boundaries, along which v is constant, have a "
                        "harmonic one of the same periods");
    }
  }
}

// #V x 2m the values at the first corner of each vertex.
forms::RowMajorMatrix first_values(const mesh::Surface& surface, const forms::RowMajorMatrix& values) {
  forms::RowMajorMatrix first(surface.vertex_count, values.cols());
  const auto& corner_vertices = surface.polygons.corner_vertices;
  for (std::size_t c = corner_vertices.size(); c-- > 0;)
    first.row(corner_vertices[c]) = values.row(static_cast<Eigen::Index>(c));
  return first;
}

// #E x 2m the differences of the corner values along half-edges 2e, the same in both triangles of an edge.
forms::RowMajorMatrix differences(const mesh::Surface& surface, const forms::RowMajorMatrix& values, double tolerance) {
  forms::RowMajorMatrix edge_values(static_cast<Eigen::Index>(surface.edges.size()), values.cols());
  std::vector<char> seen(surface.edges.size(), 0);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const int e = surface.triangle_edges[t][i], from = surface.triangle_corners[t][i],
                to = surface.triangle_corners[t][(i + 1) % 3];
      const double sign = surface.edges[e][0] == surface.triangles[t][i] ? 1 : -1;
      const Eigen::RowVectorXd along = sign * (values.row(to) - values.row(from));
      if (!seen[e]) {
        edge_values.row(e) = along;
        seen[e] = 1;
      } else if ((edge_values.row(e) - along).cwiseAbs().maxCoeff() > tolerance) {
        throw InvalidMesh("across the edge between vertices " + std::to_string(surface.edges[e][0]) + " and " +
                          std::to_string(surface.edges[e][1]) +
                          " of the level the UV map is rotated or scaled; only a map that is translated across its "
                          "seams has a harmonic one of the same periods");
      }
    }
  }
  return edge_values;
}

// The natural condition for all columns; with a boundary the columns of v, the odd ones, are fixed there.
std::vector<solver::Condition> conditions_of(Eigen::Index columns, bool bounded) {
  std::vector<solver::Condition> conditions(columns, solver::Condition::natural);
  for (Eigen::Index v = 1; bounded && v < columns; v += 2) conditions[v] = solver::Condition::dirichlet;
  return conditions;
}

forms::FluxTerms terms_of(const forms::RowMajorMatrix& edge_values) {
  return {[&edge_values](mesh::HalfedgeHandle h, Eigen::VectorXd& values) {
    values += mesh::sign(h) * edge_values.row(mesh::edge_of(h)).transpose();
  }};
}

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

double faces(const PaperLevels& levels, int splits) {
  return static_cast<double>(progressive::triangle_count(*levels.mesh, splits));
}

// Estimates the part of the work that conjugate gradients on M take, by its part of the faces of all levels.
double last_part(const PaperLevels& levels, const std::vector<int>& coarse) {
  double work = faces(levels, levels.splits);
  for (const int k : coarse) work += faces(levels, k);
  return faces(levels, levels.splits) / work;
}

structure::LevelReport level_report(const PaperLevels& levels, int splits, const solver::GradientReport& report,
                                    Clock::time_point start) {
  return {static_cast<std::int64_t>(faces(levels, splits)), report.iterations, seconds_since(start)};
}

// Without rounding, as many iterations as unknowns are enough.
int most_iterations(const solver::Laplacian& L) { return std::min(100'000, 10 * L.size()); }

// Step 5(b) for all splits between two levels; on M0 nothing is known yet.
Eigen::MatrixXd prolonged(const Eigen::MatrixXd& X, const std::vector<int>& from, const std::vector<int>& to,
                          Eigen::Index rows, Eigen::Index columns) {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(rows, columns);
  for (Eigen::Index c = 0; c < X.cols(); ++c) {
    for (std::size_t v = 0; v < from.size(); ++v) result(to[v], c) = X(from[v], c);
  }
  return result;
}

// On the surface, the class of a loop's harmonic measure is d(1 on loop k). The levels have its pull-back from M0
// instead, d of the function that is 1 at all vertices collapsed into the loop. The functions, which are 0 along the
// boundary, take the difference: 1 at the inner ones of these vertices, -1 in the second copy.
void add_collapsed_into_loops(const PaperLevels& levels, Eigen::MatrixXd& X) {
  const Eigen::Index first = X.cols() - levels.bases.boundary.count();  // loop k >= 1 is column first + k
  const std::vector<int> to_base = progressive::vertex_map(*levels.mesh, 0);
  auto second = static_cast<Eigen::Index>(levels.place.size());
  for (std::size_t v = 0; v < levels.place.size(); ++v) {
    if (levels.on_boundary(static_cast<int>(v))) continue;
    const int loop = levels.base_loop_of_vertex[to_base[levels.place[v]]];
    if (loop > 0) {
      X(static_cast<Eigen::Index>(v), first + loop) += 1;
      X(second, first + loop) -= 1;
    }
    ++second;
  }
}

std::vector<int> asked_for(const PaperLevels& levels, const std::vector<std::int64_t>& thresholds) {
  std::set<int> splits;
  for (const std::int64_t faces : thresholds) splits.insert({0, progressive::split_count(*levels.mesh, faces)});
  splits.erase(splits.lower_bound(levels.splits), splits.end());
  return {splits.begin(), splits.end()};
}

}  // namespace

HarmonicMap harmonic_map(const mesh::Surface& surface, const forms::RowMajorMatrix& corner_values,
                         const structure::Options& options, Execution& execution) {
  execution.stage("level of detail", 0.0, 0.2);
  check_topology(surface);
  auto half_edges = mesh::half_edges(surface, execution);
  const auto fixed = mesh::boundary_vertices(half_edges);
  const double tolerance = kSameVector * corner_values.cwiseAbs().maxCoeff();
  forms::RowMajorMatrix edge_values = differences(surface, corner_values, tolerance);
  check_boundary(surface, edge_values, tolerance);
  // The map is a function of the vertices and a form that is 0 away from the seams. Starting from that form, the
  // right-hand sides are large even if the map is harmonic already, and residuals relative to them mean something.
  // The values of v at the boundary stay part of the form: the function is 0 there.
  forms::RowMajorMatrix start = first_values(surface, corner_values);
  for (const int v : fixed) start(v, Eigen::seq(1, Eigen::last, 2)).setZero();
  for (std::size_t e = 0; e < surface.edges.size(); ++e) {
    edge_values.row(static_cast<Eigen::Index>(e)) -= start.row(surface.edges[e][1]) - start.row(surface.edges[e][0]);
  }
  const auto input = mesh::on_input(surface, std::move(half_edges), execution);

  execution.stage("harmonic map of the level", 0.2, 1.0);
  const auto choice = solver::choose_method(options.solver, surface.vertex_count, edge_values.cols());
  forms::RefinedSolver solver(input.half_edges, input.weights, fixed, choice, execution);
  HarmonicMap result;
  result.moves =
      solver.solve(
          forms::codifferentials(surface, input.weights, edge_values, execution.workers()),
          conditions_of(edge_values.cols(), !fixed.empty()), [&] { return terms_of(edge_values); }, execution) -
      start;
  const auto weights_of_mean = mesh::vertex_areas(surface, input.lengths);
  const Eigen::Map<const Eigen::VectorXd> areas(weights_of_mean.data(), surface.vertex_count);
  // With boundary, v is fixed there, and u alone is free up to a constant.
  Eigen::RowVectorXd mean = areas.transpose() * result.moves / areas.sum();
  if (!fixed.empty()) mean(Eigen::seq(1, Eigen::last, 2)).setZero();
  result.moves.rowwise() -= mean;
  result.solver = structure::solver_report(solver);
  execution.finish();
  return result;
}

std::vector<int> thresholds(const PaperLevels& levels, const PaperOptions& options) {
  if (options.thresholds) return asked_for(levels, *options.thresholds);
  const double base = faces(levels, 0);
  std::vector<int> splits;
  // From M downwards by the factor `ratio`, then M0; returned the other way round.
  for (double count = faces(levels, levels.splits) / options.ratio;
       count >= static_cast<double>(options.least_faces) && count > base; count /= options.ratio) {
    splits.push_back(progressive::split_count(*levels.mesh, static_cast<std::int64_t>(count)));
  }
  if (levels.splits > 0) splits.push_back(0);
  return {splits.rbegin(), splits.rend()};
}

PaperEstimation paper_estimation(const PaperLevels& levels, const std::vector<int>& coarse, const PaperOptions& options,
                                 Execution& execution) {
  double work = 0, done = 0;
  for (const int k : coarse) work += faces(levels, k);
  PaperEstimation result;
  std::vector<int> row, own(static_cast<std::size_t>(row_count(levels)));
  std::iota(own.begin(), own.end(), 0);
  Eigen::MatrixXd X;
  solver::GradientOptions gradients;
  gradients.scaling = options.scaling;
  gradients.residual = options.level_residual;
  for (const int k : coarse) {
    const auto start = Clock::now();
    LevelSystem system = level_system(levels, k);
    // 5(b): a vertex of this level begins with the value of its parent on the last one. 5(c): the system is solved from
    // there.
    X = prolonged(X, row, system.row, system.B.rows(), system.B.cols());
    execution.part(done, done + faces(levels, k) / work);
    const auto report = solver::conjugate_gradients(system.L, system.B, X, gradients, execution);
    done += faces(levels, k) / work;
    result.levels.push_back(level_report(levels, k, report, start));
    row = std::move(system.row);
  }
  // 5(b) for the splits from the last threshold to M.
  result.functions = prolonged(X, row, own, static_cast<Eigen::Index>(own.size()), levels.base_classes.form_count);
  if (!levels.closed() && !coarse.empty()) add_collapsed_into_loops(levels, result.functions);
  return result;
}

PaperSolver::PaperSolver(const PaperLevels& levels, solver::Laplacian&& L, const PaperOptions& options)
    : levels_(levels), L_(std::move(L)), options_(options) {}

solver::Solution PaperSolver::solve(const Eigen::MatrixXd& B, const std::vector<solver::Condition>& conditions,
                                    Execution& execution) {
  // The first call is for the forms themselves, all later ones for corrections.
  return std::exchange(is_begun_, true) ? correction(B, conditions, execution) : improved(B, conditions, execution);
}

std::string PaperSolver::name() const {
  if (is_begun_ && reports_.empty()) return direct_->name();
  const std::string name = options_.scaling == solver::Scaling::none ? "plain" : "scaled";
  return "paper: " + name + " conjugate gradients, " + std::to_string(reports_.size()) + " levels";
}

// Whether conjugate gradients from these levels reach the goal, or what rounding allows.
bool PaperSolver::improve(const std::vector<int>& coarse, const Eigen::MatrixXd& B, Eigen::MatrixXd& X,
                          Execution& execution) {
  const double before = 1 - last_part(levels_, coarse);
  execution.part(0, before);
  auto estimation = [&] {
    const Execution::Within within(execution);
    return paper_estimation(levels_, coarse, options_, execution);
  }();
  execution.part(before, 1);
  const auto start = Clock::now();
  X = std::move(estimation.functions);
  const auto last =
      solver::conjugate_gradients(L_, B, X, {options_.scaling, options_.residual, most_iterations(L_)}, execution);
  if (!last.converged && !last.is_rounding) {
    remark_ += remark_.empty() ? "conjugate gradients did not converge from " : ", nor from ";
    remark_ += std::to_string(coarse.size()) + " coarse levels";
    return false;
  }
  reports_ = std::move(estimation.levels);
  reports_.push_back(level_report(levels_, levels_.splits, last, start));
  iterations_ = last.iterations;
  residual_ = last.residual;
  return true;
}

solver::Solution PaperSolver::improved(const Eigen::MatrixXd& B, const std::vector<solver::Condition>& conditions,
                                       Execution& execution) {
  Eigen::MatrixXd X;
  for (auto coarse = thresholds(levels_, options_); !improve(coarse, B, X, execution); coarse.pop_back()) {
    if (coarse.empty()) return solved_directly(B, conditions, execution);
  }
  return X;
}

solver::Solution PaperSolver::correction(const Eigen::MatrixXd& B, const std::vector<solver::Condition>& conditions,
                                         Execution& execution) {
  if (direct_) return solved_directly(B, conditions, execution);
  Eigen::MatrixXd X = Eigen::MatrixXd::Zero(B.rows(), B.cols());
  const auto report = solver::conjugate_gradients(L_, B, X, {.most_iterations = most_iterations(L_)}, execution);
  if (report.converged || report.is_rounding) return X;
  remark_ += (remark_.empty() ? "" : "; ") + std::string("conjugate gradients did not converge to a correction");
  return solved_directly(B, conditions, execution);
}

solver::Solution PaperSolver::solved_directly(const Eigen::MatrixXd& B,
                                              const std::vector<solver::Condition>& conditions, Execution& execution) {
  if (!direct_) {
    remark_ += "; the direct solver took over";
    direct_ = solver::make_solver(solver::Method::direct, std::move(L_), {}, execution);
  }
  solver::Solution X = direct_->solve(B, conditions, execution);
  residual_ = std::max(residual_, direct_->residual());
  iterations_ = std::max(iterations_, direct_->iterations());
  return X;
}

structure::Structure paper_structure(std::shared_ptr<const mesh::Surface> surface, const structure::Options& options,
                                     Execution& execution, PaperOptions how, std::optional<PaperLevels> levels) {
  // All forms are refined together, level by level, in about the memory of multigrid.
  const structure::Options sizes{"multigrid", options.memory_limit, structure::Boundary::double_cover};
  auto result = structure::planned_structure(std::move(surface), sizes, structure::Keeping::all);
  structure::SolveRecord& record = result.record;
  record.memory.choice.reason = "asked for";

  execution.stage("progressive mesh", 0.0, 0.1);
  if (!levels) levels = paper_levels(*result.surface, execution);

  execution.stage("homology", 0.1, 0.2);
  auto half_edges = mesh::half_edges(*result.surface, execution);
  result.topology = structure::find_topology(*result.surface, half_edges, execution, levels->bases);

  execution.stage("Laplacian", 0.2, 0.3);
  const auto input = mesh::on_input_with_errors(*result.surface, std::move(half_edges), execution);
  record.mollification = input.mollification;
  const PaperSolver* paper = nullptr;
  const auto make = [&](solver::Laplacian&& L) {
    auto made = std::make_unique<PaperSolver>(*levels, std::move(L), how);
    paper = made.get();
    return made;
  };
  // The paper solves on the double wherever there is a boundary (§ 8).
  const auto boundary = levels->closed() ? structure::Boundary::natural : structure::Boundary::double_cover;
  structure::HarmonicSolver solver(input, record.memory, boundary, make, execution);

  execution.stage("harmonic forms", 0.3, 1.0);
  result.harmonic = structure::harmonic_forms(*result.surface, result.topology, solver, execution);
  result.differentials = result.holomorphic().differentials;
  record.solver = solver.report();
  record.solver.levels = paper->levels();
  structure::require_guaranteed(result);
  execution.finish();
  record.seconds = execution.seconds();
  return result;
}

}  // namespace holomorph::structure
