#include "pipeline/artist_forms.h"

#include "pipeline/threads.h"

namespace holomorph::pipeline {
namespace {

// Largest relative gain in energy that is given away; it bounds the squared relative distance between the forms.
constexpr double kNegligibleGain = 1e-9;

}  // namespace

HarmonicForms artist_forms(const mesh::Surface& surface, const ConformalStructure& structure, const Options& options,
                           Progress& progress) {
  if (structure.flip_count == 0) return {structure.harmonic, structure.solver};
  const ThreadCount threads(options.threads);
  progress.stage("artist's triangulation", 0.0, 0.2);
  const auto plain = mesh::intrinsic_triangulation(surface, structure.half_edges);
  const auto weights = mesh::cotangent_weights(plain, progress);
  const Eigen::VectorXd here = forms::gram_matrix(plain.half_edges, weights, structure.harmonic, progress).diagonal();
  const Eigen::VectorXd least = structure.gram_matrix.diagonal();
  if (((here - least).array() <= kNegligibleGain * least.array()).all()) return {structure.harmonic, structure.solver};

  progress.stage("harmonic forms of the artist's triangles", 0.2, 1.0);
  auto laplacian = forms::laplacian(plain.half_edges, weights, progress);
  auto result =
      harmonic_forms(plain.half_edges, weights, std::move(laplacian), structure.harmonic.classes, options, progress);
  progress.finish();
  return result;
}

}  // namespace holomorph::pipeline
