#include "structure/harmonic_forms.h"

#include <utility>

#include "structure/streamed_forms.h"

namespace holomorph::structure {

HarmonicForms harmonic_forms(const mesh::Surface& surface, const Topology& topology, HarmonicSolver& solver,
                             Execution& execution) {
  const Execution::Within within(execution);
  execution.stage("harmonic forms", 0.0, 0.75);
  const auto& discretisation = solver.discretisation();
  const auto classes = classes_on(topology, discretisation.half_edges, discretisation.flips);
  if (!solver.plan().keep_forms) return streamed_forms(surface, topology, solver, classes, execution);
  auto functions = solver.solve(classes, topology.families.natural, execution);
  execution.stage("certificates", 0.75, 1.0);
  return measured(surface, topology, discretisation, classes, std::move(functions), execution);
}

forms::RowMajorMatrix harmonic_functions(const Topology& topology, HarmonicSolver& solver, Execution& execution) {
  const auto& discretisation = solver.discretisation();
  const auto classes = classes_on(topology, discretisation.half_edges, discretisation.flips);
  auto functions = solver.solve(classes, topology.families.natural, execution);
  add_loop_indicators(topology, functions);
  return functions;
}

}  // namespace holomorph::structure
