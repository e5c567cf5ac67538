#include "structure/conformal_structure.h"

#include <utility>

#include "base/background_task.h"
#include "base/errors.h"
#include "structure/structure.h"

namespace holomorph::structure {

Structure planned_structure(std::shared_ptr<const mesh::Surface> surface, const Options& options, Keeping keeping) {
  const auto type = mesh::topological_type(*surface);
  if (type.form_count() == 0) {
    throw TopologyError("the surface has " + type.text() +
                        "; a handle, or a second boundary, is needed for harmonic forms");
  }
  Structure result;
  result.record.memory = plan_memory(*surface, type, options, keeping);
  result.surface = std::move(surface);
  return result;
}

Structure conformal_structure(std::shared_ptr<const mesh::Surface> given_surface, const Options& options,
                              Execution& execution, std::optional<topology::DualBases> given) {
  const mesh::Surface& surface = *given_surface;
  execution.stage("half-edges", 0.0, 0.05);
  Structure result = planned_structure(given_surface, options, Keeping::as_many_as_fit);
  SolveRecord& record = result.record;
  auto half_edges = mesh::half_edges(surface, execution);
  // The topology belongs to the surface's own triangles. The copy is flipped to the Delaunay triangulation.
  auto flipped = half_edges.copy(execution.workers());

  // Loops, dual classes and the cut (paper § 4, § 5) need no metric, and the next steps need no topology until forms
  // are solved for. So both run at the same time.
  execution.stage("homology", 0.05, 0.2);
  BackgroundTask homology(
      [&](Execution& own) {
        result.topology = find_topology(surface, half_edges, own, std::move(given));
        // No later step needs them: their memory is free for the solver.
        half_edges = mesh::HalfEdges();
      },
      execution);

  execution.stage("intrinsic Delaunay", 0.2, 0.25);
  const auto delaunay = mesh::on_delaunay(surface, std::move(flipped), execution);
  record.mollification = delaunay.mollification;
  record.flip_count = static_cast<int>(delaunay.flips.size());

  execution.stage("solver", 0.25, 0.45);
  HarmonicSolver solver(delaunay, record.memory, options.boundary, execution);

  execution.stage("homology", 0.45, 0.45);
  homology.wait(execution);

  execution.stage("harmonic forms", 0.45, 1.0);  // § 6, § 7
  result.harmonic = harmonic_forms(surface, result.topology, solver, execution);
  result.differentials = result.holomorphic().differentials;
  record.solver = solver.report();
  require_guaranteed(result);
  execution.finish();
  record.seconds = execution.seconds();
  return result;
}

}  // namespace holomorph::structure
