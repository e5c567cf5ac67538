#include "multiresolution/paper_forms.h"

#include <chrono>
#include <numeric>
#include <sstream>

namespace holomorph::multiresolution {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

class PaperSolve {
 public:
  PaperSolve(const PaperLevels& levels, const PaperOptions& options, Execution& execution)
      : levels_(levels), options_(options), execution_(execution), work_(faces(levels.splits)) {
    for (const int k : thresholds(levels, options)) work_ += faces(k);
  }

  // Steps 4 and 5.
  Eigen::MatrixXd estimate() {
    std::vector<int> row(levels_.place.size()), own(row.size());
    std::iota(own.begin(), own.end(), 0);
    Eigen::MatrixXd X;
    for (const int k : thresholds(levels_, options_)) {
      const auto start = Clock::now();
      LevelSystem system = level_system(levels_, k);
      X = prolonged(X, row, system.row_of_vertex, system.B.rows(), system.B.cols());
      improve(system.L, system.B, X, options_.level_residual, k, start);
      row = std::move(system.row_of_vertex);
    }
    return prolonged(X, row, own, static_cast<Eigen::Index>(own.size()), levels_.base_classes.form_count);
  }

  // Step 6.
  solver::GradientReport improve_surface(const solver::Laplacian& L, const Eigen::MatrixXd& B, Eigen::MatrixXd& X) {
    const auto start = Clock::now();
    const auto last = improve(L, B, X, options_.residual, levels_.splits, start);
    if (!last.converged) fail(last, B.rows());
    return last;
  }

  structure::SolverReport report(const solver::GradientReport& last) const {
    const std::string name = options_.scaling == solver::Scaling::none ? "plain" : "scaled";
    return {"paper: " + name + " conjugate gradients, " + std::to_string(reports_.size()) + " levels", "asked for",
            last.iterations, last.residual, reports_};
  }

 private:
  double faces(int splits) const { return static_cast<double>(levels_.mesh->base.triangles.size()) + 2.0 * splits; }

  // Step 5(b) for all splits between two levels; on M0 nothing is known yet.
  static Eigen::MatrixXd prolonged(const Eigen::MatrixXd& X, const std::vector<int>& from, const std::vector<int>& to,
                                   Eigen::Index rows, Eigen::Index columns) {
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(rows, columns);
    for (Eigen::Index c = 0; c < X.cols(); ++c) {
      for (std::size_t v = 0; v < from.size(); ++v) result(to[v], c) = X(from[v], c);
    }
    return result;
  }

  solver::GradientReport improve(const solver::Laplacian& L, const Eigen::MatrixXd& B, Eigen::MatrixXd& X,
                                 double residual, int splits, Clock::time_point start) {
    solver::GradientOptions options;
    options.scaling = options_.scaling;
    options.residual = residual;
    const double part = faces(splits) / work_;
    execution_.part(done_, done_ + part);
    const auto report = solver::conjugate_gradients(L, B, X, options, execution_);
    done_ += part;
    reports_.push_back({static_cast<std::int64_t>(faces(splits)), report.iterations, seconds_since(start)});
    return report;
  }

  [[noreturn]] void fail(const solver::GradientReport& last, Eigen::Index unknowns) const {
    std::ostringstream message;
    message << "the paper's solver reached a relative residual of " << last.residual << " instead of "
            << options_.residual << " after " << last.iterations << " iterations, on a system of " << unknowns
            << " unknowns; take one of auto, direct, multigrid";
    throw SolverError(message.str());
  }

  const PaperLevels& levels_;
  const PaperOptions& options_;
  Execution& execution_;
  std::vector<structure::LevelReport> reports_;
  double work_ = 0;  // in faces of all levels
  double done_ = 0;  // part of it
};

}  // namespace

std::vector<int> thresholds(const PaperLevels& levels, const PaperOptions& options) {
  const auto base = static_cast<double>(levels.mesh->base.triangles.size());
  std::vector<int> splits;
  for (double faces = (base + 2.0 * levels.splits) / options.ratio;
       faces >= static_cast<double>(options.least_faces) && faces > base; faces /= options.ratio) {
    splits.push_back(static_cast<int>((faces - base) / 2));
  }
  if (levels.splits > 0) splits.push_back(0);
  return {splits.rbegin(), splits.rend()};
}

PaperForms paper_estimation(const PaperLevels& levels, const PaperOptions& options, Execution& execution) {
  PaperSolve solve(levels, options, execution);
  PaperForms result{solve.estimate(), {}};
  result.solver = solve.report({});
  return result;
}

PaperForms paper_forms(const PaperLevels& levels, const solver::Laplacian& laplacian, const Eigen::MatrixXd& B,
                       const PaperOptions& options, Execution& execution) {
  PaperSolve solve(levels, options, execution);
  Eigen::MatrixXd X = solve.estimate();
  auto report = solve.report(solve.improve_surface(laplacian, B, X));
  return {X, std::move(report)};
}

}  // namespace holomorph::multiresolution
