#include "multiresolution/paper_structure.h"

#include "structure/conformal_structure.h"
#include "structure/guarantee.h"

namespace holomorph::multiresolution {

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

}  // namespace holomorph::multiresolution
