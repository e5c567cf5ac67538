#include "pipeline/artist_forms.h"

#include <algorithm>

#include "base/chunks.h"
#include "pipeline/threads.h"

namespace holomorph::pipeline {
namespace {

// Largest relative gain in energy that is given away; it bounds the squared relative distance between the forms.
constexpr double kNegligibleGain = 1e-9;

// Whether the energies `here` on the artist's triangles leave nothing to be gained over the `least` ones.
bool is_negligible(const Eigen::VectorXd& here, const Eigen::VectorXd& least) {
  return ((here - least).array() <= kNegligibleGain * least.array()).all();
}

// Edges whose values are written at a time.
constexpr int kEdgeBlock = 4096;

}  // namespace

uv::UvArray combination(const forms::RowMajorMatrix& functions, const Eigen::VectorXcd& p) {
  Eigen::Matrix<double, Eigen::Dynamic, 2> coefficients(p.size(), 2);
  coefficients << p.real(), p.imag();
  uv::UvArray result(functions.rows(), 2);
  Workers workers;
  for_rows(workers, static_cast<int>(result.rows()),
           [&](int v) { result.row(v).noalias() = functions.row(v) * coefficients; });
  return result;
}

void write_edge_values(const mesh::EdgeEnds& ends, const forms::ClosedForms& forms,
                       Eigen::Ref<forms::RowMajorMatrix> rows) {
  const auto edges = static_cast<int>(rows.cols());
  for (int begin = 0, end; begin < edges; begin = end) {
    end = std::min(begin + kEdgeBlock, edges);
    rows.middleCols(begin, end - begin) = forms::edge_values(ends, forms, begin, end).transpose();
  }
}

void ArtistForms::prepare(Progress& progress) {
  if (ready_) return;
  const ThreadCount threads(options_.threads);
  if (structure_.memory.keep_forms) {
    prepare_all(progress);
  } else {
    prepare_solver(progress);
  }
  progress.finish();
  ready_ = true;
}

void ArtistForms::prepare_all(Progress& progress) {
  report_ = structure_.solver;
  if (structure_.flip_count == 0) return;
  progress.stage("artist's triangulation", 0.0, 0.2);
  auto& harmonic = structure_.harmonic;
  if (!given_up_) {
    const Eigen::VectorXd here = forms::energies(surface_, structure_.mollification, harmonic, progress);
    if (is_negligible(here, structure_.gram_matrix.diagonal())) return;
  }
  harmonic.functions.resize(0, 0);
  given_up_ = true;
  const auto plain = mesh::intrinsic_triangulation(surface_, mesh::half_edges(surface_, progress));
  const auto weights = mesh::cotangent_weights(plain, progress);

  progress.stage("harmonic forms of the artist's triangles", 0.2, 1.0);
  auto laplacian = forms::laplacian(plain.half_edges, weights, progress);
  auto solved = harmonic_forms(plain.half_edges, weights, std::move(laplacian), harmonic.classes, options_, progress);
  harmonic.functions.swap(solved.forms.functions);
  report_ = std::move(solved.solver);
}

void ArtistForms::prepare_solver(Progress& progress) {
  progress.stage("artist's triangulation", 0.0, 0.3);
  const auto plain = mesh::intrinsic_triangulation(surface_, mesh::half_edges(surface_, progress));
  weights_ = mesh::cotangent_weights(plain, progress);
  auto laplacian = forms::laplacian(plain.half_edges, weights_, progress);
  progress.stage("solver of the artist's triangles", 0.3, 1.0);
  // A complex combination of forms is two right-hand sides.
  const Extent extent{surface_.vertex_count, static_cast<std::int64_t>(surface_.edges.size()), 2};
  choice_ = plan_memory(extent, options_.solver, options_.memory_limit).choice;
  solver_ = solver::make_solver(choice_.method, std::move(laplacian), {}, progress);
  report_ = solver_report(*solver_, choice_);
}

forms::RowMajorMatrix ArtistForms::solve(const Eigen::MatrixXd& right_hand_sides, Progress& progress) {
  forms::RowMajorMatrix functions = solver_->solve(right_hand_sides, solver::Condition::natural, progress);
  report_ = solver_report(*solver_, choice_);
  return functions;
}

uv::UvArray ArtistForms::function(const Eigen::VectorXcd& p, Progress& progress) {
  prepare(progress);
  if (structure_.memory.keep_forms) return combination(structure_.harmonic.functions, p);
  Eigen::MatrixXd parts(p.size(), 2);
  parts << p.real(), p.imag();
  const ThreadCount threads(options_.threads);
  progress.stage("harmonic forms of the map", 0.0, 1.0);
  const auto& classes = structure_.harmonic.classes;
  const uv::UvArray result = solve(forms::codifferentials(surface_, weights_, classes, parts), progress);
  progress.finish();
  return result;
}

void ArtistForms::edge_values(double* values, Progress& progress) {
  prepare(progress);
  const auto count = structure_.harmonic.classes.form_count, edges = static_cast<int>(surface_.edges.size());
  Eigen::Map<forms::RowMajorMatrix> result(values, count, edges);
  if (structure_.memory.keep_forms) {
    write_edge_values(surface_, structure_.harmonic, result);
    return;
  }
  const ThreadCount threads(options_.threads);
  progress.stage("harmonic forms", 0.0, 1.0);
  auto& block = structure_.harmonic;
  for (block.first = 0; block.first < count;) {
    const int width = std::min(structure_.memory.block, count - block.first);
    progress.part(static_cast<double>(block.first) / count, static_cast<double>(block.first + width) / count);
    block.functions = solve(forms::codifferentials(surface_, weights_, block.classes, block.first, width), progress);
    write_edge_values(surface_, block, result.middleRows(block.first, width));
    block.first += width;
  }
  block.functions.resize(0, 0);
  block.first = 0;
  progress.finish();
}

uv::FormSamples ArtistForms::samples(Progress& progress) {
  if (!structure_.memory.keep_forms) return structure_.samples;
  prepare(progress);
  const auto triangles = uv::sample_triangles(surface_);
  return {triangles, uv::values_on_sides(surface_, structure_.harmonic, triangles)};
}

HarmonicForms artist_forms(const mesh::Surface& surface, const BoundedStructure& structure, const Options& options,
                           Progress& progress) {
  if (structure.flip_count == 0) return {structure.harmonic, structure.solver};
  const ThreadCount threads(options.threads);
  progress.stage("artist's triangulation", 0.0, 0.2);
  const Eigen::VectorXd here = forms::energies(surface, structure.mollification, structure.harmonic, progress);
  Eigen::VectorXd least(here.size());
  least << structure.natural_gram.diagonal(), structure.dirichlet_gram.diagonal();
  if (is_negligible(here, least)) return {structure.harmonic, structure.solver};
  const auto plain = mesh::intrinsic_triangulation(surface, mesh::half_edges(surface, progress));
  const auto weights = mesh::cotangent_weights(plain, progress);

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
