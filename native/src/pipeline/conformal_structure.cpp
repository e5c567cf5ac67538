#include "pipeline/conformal_structure.h"

#include "base/errors.h"
#include "mesh/components.h"
#include "pipeline/paper_forms.h"
#include "pipeline/threads.h"

namespace holomorph::pipeline {
namespace {

void check_topology(const mesh::Surface& surface, const mesh::HalfEdges& half_edges) {
  const int boundaries = mesh::boundary_count(half_edges);
  const int genus = mesh::genus(mesh::euler_characteristic(surface), boundaries);
  if (genus > 0 && boundaries == 0) return;
  throw TopologyError("the surface has genus " + std::to_string(genus) + " and " + std::to_string(boundaries) +
                      " boundary loops; a closed surface of genus 1 or more is needed");
}

double largest_period_error(const Eigen::MatrixXd& periods) {
  return (periods - Eigen::MatrixXd::Identity(periods.rows(), periods.cols())).cwiseAbs().maxCoeff();
}

}  // namespace

ConformalStructure conformal_structure(const mesh::Surface& surface, const Options& options, Progress& progress,
                                       std::optional<topology::DualBases> given, std::optional<PaperLevels> levels) {
  const ThreadCount threads(options.threads);
  const bool paper = options.solver == "paper";
  ConformalStructure result;

  progress.stage("half-edges", 0.0, 0.05);
  result.half_edges = mesh::half_edges(surface, progress);
  check_topology(surface, result.half_edges);
  if (paper) {
    progress.stage("progressive mesh", 0.05, 0.1);
    if (!levels) levels = paper_levels(surface, progress);
    given = std::move(levels->bases);
  }

  progress.stage("homology", paper ? 0.1 : 0.05, 0.2);
  const auto domain = topology::fundamental_domain(surface, result.half_edges, progress);
  result.homology_basis = given ? std::move(given->loops) : topology::homology_basis(result.half_edges, domain);
  result.seams = topology::cut_graph(result.half_edges, domain);

  progress.stage("cohomology", 0.2, 0.25);
  auto classes = given ? std::move(given->classes) : topology::cohomology_basis(result.half_edges, domain);
  result.canonical = topology::canonical_basis(topology::wedge_matrix(result.half_edges, classes, progress));
  result.sheets = uv::corner_sheets(surface, result.half_edges, domain, classes, progress);

  progress.stage("intrinsic Delaunay", 0.25, 0.3);
  auto intrinsic = mesh::intrinsic_triangulation(surface, result.half_edges);
  if (!paper) mesh::make_delaunay(intrinsic, progress);
  auto intrinsic_classes = classes;
  topology::carry_through(intrinsic.flips, intrinsic_classes);

  progress.stage("Laplacian", 0.3, 0.35);
  const auto weights = mesh::cotangent_weights(intrinsic, progress);
  auto laplacian = forms::laplacian(intrinsic.half_edges, weights, progress);

  progress.stage("harmonic forms", 0.35, 0.85);
  const auto solved =
      paper ? paper_forms(*levels, intrinsic.half_edges, weights, laplacian, intrinsic_classes, progress)
            : harmonic_forms(intrinsic.half_edges, weights, std::move(laplacian), intrinsic_classes, options, progress);
  const forms::ClosedForms& harmonic = solved.forms;
  result.solver = solved.solver;

  progress.stage("holomorphic forms", 0.85, 0.92);
  result.gram_matrix = forms::gram_matrix(intrinsic.half_edges, weights, harmonic, progress);
  result.holomorphic = conformal::holomorphic_basis(result.gram_matrix, result.canonical);

  progress.stage("certificates", 0.92, 1.0);
  result.residuals = forms::residuals(intrinsic.half_edges, weights, harmonic, progress);
  result.harmonic = {std::move(classes), harmonic.functions};
  result.period_residual =
      largest_period_error(forms::periods(result.half_edges, result.harmonic, result.homology_basis));
  result.mollification = intrinsic.mollification;
  result.flip_count = static_cast<int>(intrinsic.flips.size());
  progress.finish();
  result.seconds = progress.seconds();
  return result;
}

}  // namespace holomorph::pipeline
