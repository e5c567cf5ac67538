#include "pipeline/artist_forms.h"

#include <algorithm>

#include "base/chunks.h"

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

uv::UvArray combination(const forms::RowMajorMatrix& functions, const Eigen::VectorXcd& p, Workers& workers) {
  Eigen::Matrix<double, Eigen::Dynamic, 2> coefficients(p.size(), 2);
  coefficients << p.real(), p.imag();
  uv::UvArray result(functions.rows(), 2);
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

void ArtistForms::prepare(Execution& execution) {
  if (ready_) return;
  if (structure_.memory.keep_forms) {
    prepare_all(execution);
  } else {
    prepare_solver(execution);
  }
  execution.finish();
  ready_ = true;
}

void ArtistForms::prepare_all(Execution& execution) {
  report_ = structure_.solver;
  if (structure_.flip_count == 0) return;
  execution.stage("artist's triangulation", 0.0, 0.2);
  auto& harmonic = structure_.harmonic;
  if (!given_up_) {
    const Eigen::VectorXd here = forms::energies(surface_, structure_.mollification, harmonic, execution);
    if (is_negligible(here, structure_.gram_matrix.diagonal())) return;
  }
  harmonic.functions.resize(0, 0);
  given_up_ = true;
  const auto plain =
      mesh::intrinsic_triangulation(surface_, mesh::half_edges(surface_, execution), execution.workers());
  const auto weights = mesh::cotangent_weights(plain, execution);

  execution.stage("harmonic forms of the artist's triangles", 0.2, 1.0);
  auto laplacian = forms::laplacian(plain.half_edges, weights, execution);
  auto solved = harmonic_forms(plain.half_edges, weights, std::move(laplacian), harmonic.classes, options_, execution);
  harmonic.functions.swap(solved.forms.functions);
  report_ = std::move(solved.solver);
}

void ArtistForms::prepare_solver(Execution& execution) {
  execution.stage("artist's triangulation", 0.0, 0.3);
  const auto plain =
      mesh::intrinsic_triangulation(surface_, mesh::half_edges(surface_, execution), execution.workers());
  weights_ = mesh::cotangent_weights(plain, execution);
  auto laplacian = forms::laplacian(plain.half_edges, weights_, execution);
  execution.stage("solver of the artist's triangles", 0.3, 1.0);
  // A complex combination of forms is two right-hand sides.
  const Extent extent{surface_.vertex_count, static_cast<std::int64_t>(surface_.edges.size()), 2};
  choice_ = plan_memory(extent, options_.solver, options_.memory_limit).choice;
  solver_ = solver::make_solver(choice_.method, std::move(laplacian), {}, execution);
  report_ = solver_report(*solver_, choice_);
}

forms::RowMajorMatrix ArtistForms::solve(const Eigen::MatrixXd& right_hand_sides, Execution& execution) {
  forms::RowMajorMatrix functions = solver_->solve(right_hand_sides, solver::Condition::natural, execution);
  report_ = solver_report(*solver_, choice_);
  return functions;
}

uv::UvArray ArtistForms::function(const Eigen::VectorXcd& p, Execution& execution) {
  prepare(execution);
  if (structure_.memory.keep_forms) return combination(structure_.harmonic.functions, p, execution.workers());
  Eigen::MatrixXd parts(p.size(), 2);
  parts << p.real(), p.imag();
  execution.stage("harmonic forms of the map", 0.0, 1.0);
  const auto& classes = structure_.harmonic.classes;
  const uv::UvArray result =
      solve(forms::codifferentials(surface_, weights_, classes, parts, execution.workers()), execution);
  execution.finish();
  return result;
}

void ArtistForms::edge_values(double* values, Execution& execution) {
  prepare(execution);
  const auto count = structure_.harmonic.classes.form_count, edges = static_cast<int>(surface_.edges.size());
  Eigen::Map<forms::RowMajorMatrix> result(values, count, edges);
  if (structure_.memory.keep_forms) {
    write_edge_values(surface_, structure_.harmonic, result);
    return;
  }
  execution.stage("harmonic forms", 0.0, 1.0);
  auto& block = structure_.harmonic;
  for (block.first = 0; block.first < count;) {
    const int width = std::min(structure_.memory.block, count - block.first);
    execution.part(static_cast<double>(block.first) / count, static_cast<double>(block.first + width) / count);
    block.functions = solve(
        forms::codifferentials(surface_, weights_, block.classes, block.first, width, execution.workers()), execution);
    write_edge_values(surface_, block, result.middleRows(block.first, width));
    block.first += width;
  }
  block.functions.resize(0, 0);
  block.first = 0;
  execution.finish();
}

uv::FormSamples ArtistForms::samples(Execution& execution) {
  if (!structure_.memory.keep_forms) return structure_.samples;
  prepare(execution);
  const auto triangles = uv::sample_triangles(surface_);
  return {triangles, uv::values_on_sides(surface_, structure_.harmonic, triangles)};
}

HarmonicForms artist_forms(const mesh::Surface& surface, const BoundedStructure& structure, const Options& options,
                           Execution& execution) {
  if (structure.flip_count == 0) return {structure.harmonic, structure.solver};
  execution.stage("artist's triangulation", 0.0, 0.2);
  const Eigen::VectorXd here = forms::energies(surface, structure.mollification, structure.harmonic, execution);
  Eigen::VectorXd least(here.size());
  least << structure.natural_gram.diagonal(), structure.dirichlet_gram.diagonal();
  if (is_negligible(here, least)) return {structure.harmonic, structure.solver};
  const auto plain = mesh::intrinsic_triangulation(surface, mesh::half_edges(surface, execution), execution.workers());
  const auto weights = mesh::cotangent_weights(plain, execution);

  execution.stage("harmonic forms of the artist's triangles", 0.2, 1.0);
  auto laplacian = forms::laplacian(plain.half_edges, weights, execution);
  const int n = static_cast<int>(structure.pairing.rows());
  const auto natural = topology::first_forms(structure.harmonic.classes, n, n);
  auto solved =
      bounded_forms(plain.half_edges, weights, std::move(laplacian), natural, structure.boundary, options, execution);
  execution.finish();
  return {{structure.harmonic.classes, side_by_side(solved)}, solved.solver};
}

}  // namespace holomorph::pipeline
