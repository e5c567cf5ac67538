#include "multiresolution/paper_forms.h"

#include <chrono>
#include <numeric>
#include <set>
#include <sstream>

#include "base/errors.h"

namespace holomorph::multiresolution {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

double faces(const PaperLevels& levels, int splits) {
  return static_cast<double>(progressive::triangle_count(*levels.mesh, splits));
}

// Estimates the part of the work that conjugate gradients on M take, by its part of the faces of all levels.
double last_part(const PaperLevels& levels, const PaperOptions& options) {
  double work = faces(levels, levels.splits);
  for (const int k : thresholds(levels, options)) work += faces(levels, k);
  return faces(levels, levels.splits) / work;
}

structure::LevelReport level_report(const PaperLevels& levels, int splits, const solver::GradientReport& report,
                                    Clock::time_point start) {
  return {static_cast<std::int64_t>(faces(levels, splits)), report.iterations, seconds_since(start)};
}

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

PaperEstimation paper_estimation(const PaperLevels& levels, const PaperOptions& options, Execution& execution) {
  const std::vector<int> coarse = thresholds(levels, options);
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

solver::Solution PaperSolver::solve(const Eigen::MatrixXd& B, const std::vector<solver::Condition>&,
                                    Execution& execution) {
  // The first call is for the forms themselves, all later ones for corrections.
  return reports_.empty() ? improved(B, execution) : correction(B, execution);
}

std::string PaperSolver::name() const {
  const std::string name = options_.scaling == solver::Scaling::none ? "plain" : "scaled";
  return "paper: " + name + " conjugate gradients, " + std::to_string(reports_.size()) + " levels";
}

solver::Solution PaperSolver::improved(const Eigen::MatrixXd& B, Execution& execution) {
  const double before = 1 - last_part(levels_, options_);
  execution.part(0, before);
  auto estimation = [&] {
    const Execution::Within within(execution);
    return paper_estimation(levels_, options_, execution);
  }();
  execution.part(before, 1);
  const auto start = Clock::now();
  const solver::GradientOptions gradients{options_.scaling, options_.residual};
  const auto last = solver::conjugate_gradients(L_, B, estimation.functions, gradients, execution);
  reports_ = std::move(estimation.levels);
  reports_.push_back(level_report(levels_, levels_.splits, last, start));
  iterations_ = last.iterations;
  residual_ = last.residual;
  if (last.converged) return std::move(estimation.functions);
  std::ostringstream message;
  message << "the paper's solver reached a relative residual of " << last.residual << " instead of "
          << options_.residual << " after " << last.iterations << " iterations, on a system of " << B.rows()
          << " unknowns; take one of auto, direct, multigrid";
  throw SolverError(message.str());
}

solver::Solution PaperSolver::correction(const Eigen::MatrixXd& B, Execution& execution) const {
  Eigen::MatrixXd X = Eigen::MatrixXd::Zero(B.rows(), B.cols());
  const auto report = solver::conjugate_gradients(L_, B, X, {}, execution);
  if (report.converged) return X;
  throw SolverError("conjugate gradients failed to refine the harmonic forms on a system of " +
                    std::to_string(B.rows()) + " unknowns; take one of auto, direct, multigrid");
}

}  // namespace holomorph::multiresolution
