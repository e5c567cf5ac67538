#include "structure/conformal_structure.h"

#include "base/background_task.h"
#include "base/errors.h"
#include "mesh/delaunay.h"
#include "mesh/metric_errors.h"
#include "structure/double_cover.h"
#include "structure/guarantee.h"
#include "structure/invariants.h"
#include "structure/streamed_forms.h"

namespace holomorph::structure {
namespace {

mesh::TopologicalType checked_type(const mesh::Surface& surface) {
  const auto type = mesh::topological_type(surface);
  if (type.form_count() > 0) return type;
  throw TopologyError("the surface has " + type.text() +
                      "; a handle, or a second boundary loop, is needed for harmonic forms");
}

MemoryPlan planned(const mesh::Surface& surface, const mesh::TopologicalType& type, const Options& options) {
  const int families = type.closed() ? 1 : 2;
  return plan_memory(
      {surface.vertex_count, static_cast<std::int64_t>(surface.edges.size()), families * type.form_count()},
      options.solver, options.memory_limit, type.closed() ? Keeping::as_many_as_fit : Keeping::all);
}

}  // namespace

Structure conformal_structure(std::shared_ptr<const mesh::Surface> given_surface, const Options& options,
                              Execution& execution, std::optional<topology::DualBases> given) {
  const mesh::Surface& surface = *given_surface;
  Structure result;
  result.surface = std::move(given_surface);

  execution.stage("half-edges", 0.0, 0.05);
  const auto type = checked_type(surface);
  result.memory = planned(surface, type, options);
  auto half_edges = mesh::half_edges(surface, execution);
  auto triangulation = mesh::given_triangulation(surface, half_edges.copy(execution.workers()), execution.workers());

  // Loops, dual classes and the cut (paper § 4, § 5) need no metric, and what follows no topology until forms are
  // solved for.
  execution.stage("homology", 0.05, 0.2);
  BackgroundTask homology(
      [&](Execution& own) {
        result.topology = find_topology(surface, half_edges, own, std::move(given));
        half_edges = mesh::HalfEdges();
      },
      execution);

  execution.stage("intrinsic Delaunay", 0.2, 0.25);
  const std::vector<int> fixed = mesh::boundary_vertices(triangulation.half_edges);
  mesh::make_delaunay(triangulation, execution);
  const auto weights = mesh::cotangent_weights(triangulation, execution);
  const auto errors = mesh::energy_errors(triangulation.metric(), weights, execution.workers());
  result.certificate.metric = mesh::largest_error(triangulation.metric());
  triangulation.forget_metric();
  result.mollification = triangulation.mollification;
  result.flip_count = static_cast<int>(triangulation.flips.size());

  execution.stage("solver", 0.25, 0.45);
  std::optional<HarmonicSystems> systems;
  if (options.boundary == Boundary::natural)
    systems.emplace(triangulation.half_edges, weights, fixed, result.memory.choice, execution);

  execution.stage("homology", 0.45, 0.45);
  homology.wait(execution);
  const int natural = result.topology.families.natural;
  auto classes = topology::first_forms(result.topology.classes, natural, natural);
  topology::pull_back(triangulation.flips, classes);
  classes = harmonic_classes(result.topology, triangulation.half_edges, classes);

  execution.stage("harmonic forms", 0.45, 0.85);  // § 6
  if (!result.memory.keep_forms) {
    measure_in_blocks(triangulation.half_edges, weights, errors, *systems, std::move(classes), result, execution);
  } else {
    auto solved = systems ? systems->solve(classes, natural, result.memory.block, execution)
                          : solve_on_double(triangulation.half_edges, weights, classes, natural, options, execution);
    systems.reset();
    result.functions.swap(solved.functions);
    result.solver = std::move(solved.solver);
    execution.stage("certificates", 0.85, 1.0);
    complete(triangulation.half_edges, weights, errors, classes, result, execution);
  }
  require_guaranteed(result);
  execution.finish();
  result.seconds = execution.seconds();
  return result;
}

}  // namespace holomorph::structure
