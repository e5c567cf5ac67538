#include "multiresolution/paper_structure.h"

#include "base/errors.h"
#include "forms/codifferential.h"
#include "forms/laplacian.h"
#include "multiresolution/paper_forms.h"
#include "structure/conformal_structure.h"
#include "structure/guarantee.h"

namespace holomorph::multiresolution {
namespace {

// Corrections by the paper's conjugate gradients.
class Gradients final : public solver::LaplaceSolver {
 public:
  explicit Gradients(const solver::Laplacian& L) : L_(L) {}

  solver::Solution solve(const Eigen::MatrixXd& B, const std::vector<solver::Condition>&,
                         Execution& execution) override {
    Eigen::MatrixXd X = Eigen::MatrixXd::Zero(B.rows(), B.cols());
    const auto report = solver::conjugate_gradients(L_, B, X, {}, execution);
    if (!report.converged) {
      throw SolverError("conjugate gradients do not refine the harmonic forms, on a system of " +
                        std::to_string(B.rows()) + " unknowns; take one of auto, direct, multigrid");
    }
    return X;
  }

  std::string name() const override { return "conjugate gradients"; }

 private:
  const solver::Laplacian& L_;
};

}  // namespace

structure::Structure paper_structure(std::shared_ptr<const mesh::Surface> surface, const structure::Options& options,
                                     Execution& execution, std::optional<PaperLevels> levels) {
  const auto type = mesh::topological_type(*surface);
  if (!type.closed() || type.genus == 0) {
    throw TopologyError("the paper's solver is for closed surfaces of genus 1 or more; the surface has " + type.text() +
                        "; take one of auto, direct, multigrid");
  }
  // All forms are refined together, level by level, in about the memory of multigrid.
  const structure::Options sizes{"multigrid", options.memory_limit};
  auto result = structure::planned_structure(std::move(surface), sizes, structure::Keeping::all);
  structure::SolveRecord& record = result.record;
  record.memory.choice.reason = "asked for";

  execution.stage("progressive mesh", 0.0, 0.1);
  if (!levels) levels = paper_levels(*result.surface, execution);

  execution.stage("homology", 0.1, 0.2);
  auto half_edges = mesh::half_edges(*result.surface, execution);
  result.topology = structure::find_topology(*result.surface, half_edges, execution, std::move(levels->bases));

  execution.stage("Laplacian", 0.2, 0.3);
  const auto input = mesh::on_input(*result.surface, std::move(half_edges), execution);
  record.mollification = input.mollification;
  const auto laplacian = forms::laplacian(input.half_edges, input.weights, execution);

  execution.stage("harmonic forms", 0.3, 0.85);
  const auto& classes = result.topology.classes;
  const auto B = forms::codifferentials(input.half_edges, input.weights, classes, execution.workers());
  auto [functions, report] = paper_forms(*levels, laplacian, B, {}, execution);
  record.solver = std::move(report);
  forms::RefinedSolver refined(input.half_edges, input.weights, {}, record.memory.choice,
                               std::make_unique<Gradients>(laplacian), execution.workers());
  refined.refine(
      functions, std::vector<solver::Condition>(classes.form_count, solver::Condition::natural),
      [&] { return forms::class_terms(classes, 0, classes.form_count); }, execution);
  if (refined.is_stiff()) record.solver.residual = refined.residual();

  execution.stage("certificates", 0.85, 1.0);
  result.harmonic =
      structure::measured(*result.surface, result.topology, input, classes, std::move(functions), execution);
  result.differentials = result.holomorphic().differentials;
  structure::require_guaranteed(result);
  execution.finish();
  record.seconds = execution.seconds();
  return result;
}

}  // namespace holomorph::multiresolution
