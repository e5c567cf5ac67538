#include "pipeline/artist_forms.h"

#include "pipeline/threads.h"

namespace holomorph::pipeline {
namespace {

// Largest relative gain in energy that is given away; it bounds the squared relative distance between the forms.
constexpr double kNegligibleGain = 1e-9;

// Whether the energies `here` on the artist's triangles leave nothing to be gained over the `least` ones.
bool is_negligible(const Eigen::VectorXd& here, const Eigen::VectorXd& least) {
  return ((here - least).array() <= kNegligibleGain * least.array()).all();
}

}  // namespace

HarmonicForms artist_forms(const mesh::Surface& surface, const ConformalStructure& structure, const Options& options,
                           Progress& progress) {
  if (structure.flip_count == 0) return {structure.harmonic, structure.solver};
  const ThreadCount threads(options.threads);
  progress.stage("artist's triangulation", 0.0, 0.2);
  const auto plain = mesh::intrinsic_triangulation(surface, structure.half_edges);
  const auto weights = mesh::cotangent_weights(plain, progress);
  const Eigen::VectorXd here = forms::energies(plain.half_edges, weights, structure.harmonic, progress);
  if (is_negligible(here, structure.gram_matrix.diagonal())) return {structure.harmonic, structure.solver};

  progress.stage("harmonic forms of the artist's triangles", 0.2, 1.0);
  auto laplacian = forms::laplacian(plain.half_edges, weights, progress);
  auto result =
      harmonic_forms(plain.half_edges, weights, std::move(laplacian), structure.harmonic.classes, options, progress);
  progress.finish();
  return result;
}

HarmonicForms artist_forms(const mesh::Surface& surface, const BoundedStructure& structure, const Options& options,
                           Progress& progress) {
  if (structure.flip_count == 0) return {structure.harmonic, structure.solver};
  const ThreadCount threads(options.threads);
  progress.stage("artist's triangulation", 0.0, 0.2);
  const auto plain = mesh::intrinsic_triangulation(surface, structure.half_edges);
  const auto weights = mesh::cotangent_weights(plain, progress);
  const Eigen::VectorXd here = forms::energies(plain.half_edges, weights, structure.harmonic, progress);
  Eigen::VectorXd least(here.size());
  least << structure.natural_gram.diagonal(), structure.dirichlet_gram.diagonal();
  if (is_negligible(here, least)) return {structure.harmonic, structure.solver};

  progress.stage("harmonic forms of the artist's triangles", 0.2, 1.0);
  auto laplacian = forms::laplacian(plain.half_edges, weights, progress);
  const int n = static_cast<int>(structure.pairing.rows());
  const auto natural = topology::first_forms(structure.harmonic.classes, n, n);
  auto solved =
      bounded_forms(plain.half_edges, weights, std::move(laplacian), natural, structure.boundary, options, progress);
  progress.finish();
  return {{structure.harmonic.classes, side_by_side(solved)}, solved.solver};
}

}  // namespace holomorph::pipeline
