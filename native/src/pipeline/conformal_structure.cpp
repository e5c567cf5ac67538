#include "pipeline/conformal_structure.h"

#include "base/background_task.h"
#include "base/errors.h"
#include "mesh/components.h"
#include "pipeline/paper_forms.h"
#include "pipeline/streamed_forms.h"

namespace holomorph::pipeline {
namespace {

int checked_genus(const mesh::Surface& surface, const mesh::HalfEdges& half_edges) {
  const int boundaries = mesh::boundary_count(half_edges);
  const int genus = mesh::genus(mesh::euler_characteristic(surface), boundaries);
  if (genus > 0 && boundaries == 0) return genus;
  throw TopologyError("the surface has genus " + std::to_string(genus) + " and " + std::to_string(boundaries) +
                      " boundary loops; a closed surface of genus 1 or more is needed");
}

// All forms at once: the Gram matrix is the full energy <h_i, h_j>, the residuals those of all of them.
void keep(const mesh::Surface& surface, const mesh::IntrinsicTriangulation& intrinsic, std::span<const double> weights,
          HarmonicForms&& solved, ConformalStructure& result, Execution& execution) {
  const auto& mesh = intrinsic.half_edges;
  result.solver = std::move(solved.solver);
  execution.stage("certificates", 0.85, 0.95);
  result.gram_matrix = forms::gram_matrix(mesh, weights, solved.forms, execution);
  result.residuals = forms::residuals(mesh, weights, solved.forms, execution);
  result.harmonic.functions.swap(solved.forms.functions);
  result.period_residual = period_residual(surface, result.harmonic, result.homology_basis);
}

// A few forms at a time, of which nothing is left but what is asked of them.
void measure(const mesh::Surface& surface, const mesh::IntrinsicTriangulation& intrinsic,
             std::span<const double> weights, solver::LaplaceSolver& solver, topology::IntegerForms&& classes,
             ConformalStructure& result, Execution& execution) {
  forms::ClosedForms on_intrinsic{std::move(classes), {}};
  auto streamed = streamed_forms(surface, result.homology_basis, result.harmonic, intrinsic.half_edges, weights, solver,
                                 on_intrinsic, result.memory, execution);
  result.solver = std::move(streamed.solver);
  result.gram_matrix = std::move(streamed.gram_matrix);
  result.asymmetry = streamed.asymmetry;
  result.residuals = streamed.residuals;
  result.period_residual = streamed.period_residual;
  result.samples = std::move(streamed.samples);
}

// Loops, dual classes, canonical basis and the cut (paper § 4, 5): nothing here needs the intrinsic triangulation or
// the solver, nor these the topology, until forms are solved for. The half-edges are its own: their memory is free for
// the solver as soon as it is done. @return the classes
topology::IntegerForms find_topology(const mesh::Surface& surface, mesh::HalfEdges half_edges,
                                     std::optional<topology::DualBases> given, ConformalStructure& result,
                                     Execution& execution) {
  execution.part(0, 0.8);
  const auto domain = topology::fundamental_domain(surface, half_edges, execution);
  result.homology_basis = given ? std::move(given->loops) : topology::homology_basis(half_edges, domain);
  result.seams = topology::cut_graph(half_edges, domain);
  execution.part(0.8, 1);
  auto classes = given ? std::move(given->classes) : topology::cohomology_basis(half_edges, domain);
  result.canonical = topology::canonical_basis(topology::wedge_matrix(half_edges, classes, execution));
  result.sheets = uv::corner_sheets(surface, half_edges, domain, classes, execution);
  return classes;
}

}  // namespace

ConformalStructure conformal_structure(const mesh::Surface& surface, const Options& options, Execution& execution,
                                       std::optional<topology::DualBases> given, std::optional<PaperLevels> levels) {
  const bool paper = options.solver == "paper";
  ConformalStructure result;

  execution.stage("half-edges", 0.0, 0.05);
  auto half_edges = mesh::half_edges(surface, execution);
  const int genus = checked_genus(surface, half_edges);
  result.memory = plan_memory({surface.vertex_count, static_cast<std::int64_t>(surface.edges.size()), 2 * genus},
                              options.solver, options.memory_limit);
  if (paper) {
    execution.stage("progressive mesh", 0.05, 0.1);
    if (!levels) levels = paper_levels(surface, execution);
    given = std::move(levels->bases);
    execution.stage("half-edges", 0.1, 0.1);
  }
  auto intrinsic = mesh::intrinsic_triangulation(surface, half_edges.copy(execution.workers()), execution.workers());

  execution.stage("homology", paper ? 0.1 : 0.05, 0.2);
  topology::IntegerForms classes;
  BackgroundTask homology(
      [&](Execution& p) { classes = find_topology(surface, std::move(half_edges), std::move(given), result, p); },
      execution);

  execution.stage("intrinsic Delaunay", 0.2, 0.25);
  if (!paper) mesh::make_delaunay(intrinsic, execution);
  const auto weights = mesh::cotangent_weights(intrinsic, execution);
  intrinsic.forget_metric();

  execution.stage("Laplacian", 0.25, 0.3);
  auto laplacian = forms::laplacian(intrinsic.half_edges, weights, execution);

  execution.stage("solver", 0.3, 0.45);
  std::unique_ptr<solver::LaplaceSolver> solver;
  if (!paper) solver = solver::make_solver(result.memory.choice.method, std::move(laplacian), {}, execution);

  execution.stage("homology", 0.45, 0.45);
  homology.wait(execution);
  auto intrinsic_classes = classes;
  topology::carry_through(intrinsic.flips, intrinsic_classes);

  execution.stage("harmonic forms", 0.45, 0.85);
  result.harmonic.classes = std::move(classes);
  if (paper) {
    keep(surface, intrinsic, weights,
         paper_forms(*levels, intrinsic.half_edges, weights, laplacian, intrinsic_classes, execution), result,
         execution);
  } else if (result.memory.keep_forms) {
    auto solved = harmonic_forms(intrinsic.half_edges, weights, *solver, intrinsic_classes, result.memory, execution);
    solver.reset();
    keep(surface, intrinsic, weights, std::move(solved), result, execution);
  } else {
    measure(surface, intrinsic, weights, *solver, std::move(intrinsic_classes), result, execution);
    solver.reset();
  }

  execution.stage("holomorphic forms", 0.95, 1.0);
  result.holomorphic = conformal::holomorphic_basis(result.gram_matrix, result.canonical);
  result.mollification = intrinsic.mollification;
  result.flip_count = static_cast<int>(intrinsic.flips.size());
  execution.finish();
  result.seconds = execution.seconds();
  return result;
}

}  // namespace holomorph::pipeline
