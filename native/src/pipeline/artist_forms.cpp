#include "pipeline/artist_forms.h"

#include "pipeline/threads.h"

namespace holomorph::pipeline {
namespace {

// Largest relative gain in energy that is given away; it bounds the squared relative distance between the forms.
constexpr double kNegligibleGain = 1e-9;

}  // namespace

forms::ClosedForms artist_forms(const mesh::Surface& surface, const ConformalStructure& structure, const Options& options, Progress& progress) {
  if (structure.flip_count == 0) return structure.harmonic;
  const ThreadCount threads(options.threads);
  progress.stage("artist's triangulation", 0.0, 0.2);
  const auto plain = mesh::intrinsic_triangulation(surface, structure.half_edges);
  const auto weights = mesh::cotangent_weights(plain, progress);
  const Eigen::VectorXd here = forms::gram_matrix(plain.half_edges, weights, structure.harmonic, progress).diagonal();
  const Eigen::VectorXd least = structure.gram_matrix.diagonal();
  if (((here - least).array() <= kNegligibleGain * least.array()).all()) return structure.harmonic;

  progress.stage("harmonic forms of the artist's triangles", 0.2, 1.0);
  const auto solver = solver::make_direct_solver(forms::laplacian(plain.half_edges, weights, progress), progress);
  auto forms = forms::harmonic_basis(plain.half_edges, weights, structure.harmonic.classes, *solver, progress);
  progress.finish();
  return forms;
}

}  // namespace holomorph::pipeline
