#include "tiling/greens/pole_basis.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/errors.h"
#include "mesh/triangle_geometry.h"
#include "uv/balance.h"

namespace holomorph::tiling {
namespace {

// Beyond this weight a flux has less than nine certain digits.
constexpr double kUncertain = 1e7;

// Samples for each triangle, at most: the cost of the search for poles is proportional to them.
constexpr int kSamplesPerTriangle = 2;

// The largest triangle at each vertex.
std::vector<int> largest_triangles(const mesh::Surface& surface) {
  std::vector<int> result(surface.vertex_count, -1);
  std::vector<double> area(surface.vertex_count, -1);
  for (int t = 0; t < static_cast<int>(surface.triangles.size()); ++t) {
    const auto& [a, b, c] = surface.triangle_edges[t];
    const double own = mesh::triangle_area(surface.edge_lengths[a], surface.edge_lengths[b], surface.edge_lengths[c]);
    for (const int v : surface.triangles[t]) {
      if (own <= area[v]) continue;
      area[v] = own;
      result[v] = t;
    }
  }
  return result;
}

// The ends of edges of large weight, and their neighbours.
std::vector<char> uncertain_vertices(const mesh::Surface& surface, const Array<double>& weights) {
  std::vector<char> at_end, result;
  for (std::size_t e = 0; e < weights.size(); ++e) {
    if (std::abs(weights[e]) <= kUncertain) continue;
    at_end.resize(surface.vertex_count, 0);
    for (const int v : surface.edges[e]) at_end[v] = 1;
  }
  if (at_end.empty()) return {};
  result = at_end;
  for (const auto& [a, b] : surface.edges) {
    if (at_end[a] || at_end[b]) result[a] = result[b] = 1;
  }
  return result;
}

}  // namespace

GreensFunctions GreensFunctions::on(std::shared_ptr<const PoleBasis> surface) && {
  GreensFunctions result(std::move(surface));
  result.known_ = std::move(known_);
  return result;
}

void GreensFunctions::solve_at(const std::vector<int>& vertices, Execution& execution) {
  std::vector<int> missing;
  for (const int v : vertices) {
    if (const int solved = basis_->solved_vertex(v); !known_.contains(solved)) missing.push_back(solved);
  }
  std::sort(missing.begin(), missing.end());
  missing.erase(std::unique(missing.begin(), missing.end()), missing.end());
  for (auto first = missing.begin(); first != missing.end();) {
    const auto end = first + std::min<std::ptrdiff_t>(kGreensBlock, missing.end() - first);
    const MatrixXcd block = basis_->solve_greens({first, end}, execution);
    for (Index i = 0; i < block.cols(); ++i) known_.emplace(*first++, block.col(i));
  }
}

MatrixXcd GreensFunctions::at(const std::vector<int>& vertices, int every) const {
  const auto wanted = Eigen::seq(0, Eigen::last, every);
  const auto rows = (static_cast<Index>(basis_->samples().size()) + every - 1) / every;
  MatrixXcd values(rows, static_cast<Index>(vertices.size()));
  for (Index i = 0; i < values.cols(); ++i)
    values.col(i) = known_.at(basis_->solved_vertex(vertices[static_cast<std::size_t>(i)]))(wanted);
  // Solved for on the level: A belongs to the frames of its triangles.
  if (basis_->from_level().size() == 0) return values;
  return basis_->from_level()(wanted).asDiagonal() * values;
}

MatrixXcd GreensFunctions::pole_forms(const std::vector<int>& vertices, int every) const {
  const MatrixXcd each = at(vertices, every);
  if (!basis_->closed() || vertices.empty()) return each;
  const Index k = each.cols() - 1;
  return each.leftCols(k).colwise() - each.col(k);
}

PoleBasis::PoleBasis(std::shared_ptr<const mesh::Surface> surface, const structure::Options& options,
                     Execution& execution)
    : samples_(uv::sample_triangles(*surface, kSamplesPerTriangle)) {
  structure_.surface = std::move(surface);
  solve(options, execution);
}

PoleBasis::PoleBasis(std::shared_ptr<const mesh::Surface> surface, const structure::Options& options,
                     std::shared_ptr<const PoleBasis> on_level, const CoarseLevel& level, Execution& execution)
    : on_level_(std::move(on_level)), level_vertex_(level.collapsed) {
  structure_.surface = std::move(surface);
  const std::vector<int> triangle_at = largest_triangles(this->surface());
  const mesh::Surface& coarse = on_level_->surface();
  // A sample of the level is a triangle of the level. The largest triangle at its first vertex stands for it.
  for (const int t : on_level_->samples()) samples_.push_back(triangle_at[level.vertex[coarse.triangles[t][0]]]);
  // The vector A (e_x + i e_y) of the level is nearest to one of the surface's triangle if A is multiplied by this
  // product of the frames.
  const MatrixXcd there = uv::tangent_frames(coarse, on_level_->samples()),
                  here = uv::tangent_frames(this->surface(), samples_);
  from_level_ = (here.conjugate().cwiseProduct(there)).colwise().sum().transpose() / 2;
  solve(options, execution);
}

void PoleBasis::solve(const structure::Options& options, Execution& execution) {
  discretisation_ = mesh::on_input(surface(), mesh::half_edges(surface(), execution), execution);
  uncertain_ = uncertain_vertices(surface(), weights());
  vertex_share_ = mesh::vertex_areas(surface(), lengths());
  for (const double a : vertex_share_) area_ += a;
  for (double& a : vertex_share_) a /= area_;
  sides_.emplace(surface());

  structure_.topology = structure::find_topology(surface(), half_edges(), execution);
  const structure::Families& families = structure_.topology.families;
  structure_.harmonic.functions = std::make_shared<const forms::RowMajorMatrix>(surface().vertex_count, 0);
  holomorphic_.M.resize(static_cast<Index>(samples_.size()), 0);
  holomorphic_.N = holomorphic_.M;
  // A surface without forms needs no solver: its Green's functions come from the level.
  if (families.natural == 0 && on_level_) return;
  const int right_hand_sides = families.count() + (on_level_ ? 0 : kGreensBlock);
  solver_ = std::make_shared<const Solver>([=, this](Execution& asking) {
    return std::make_unique<structure::HarmonicSolver>(discretisation_, right_hand_sides, options, asking);
  });
  if (families.natural == 0) return;
  structure_.harmonic =
      structure::harmonic_forms(surface(), structure_.topology, *solver_->borrow(execution), execution);
  structure_.differentials = structure_.holomorphic().differentials;
  const auto values = uv::values_on_sides(surface(), *sides_, harmonic(), samples_);
  holomorphic_ = uv::sampled_parts(surface(), {samples_, values}, structure_.differentials);
  // Maps of polygons have triangles of their own (tiling/maps/assemble.h), and Green's functions are solved for on the
  // level.
  if (on_level_ && surface().has_diagonals()) solver_.reset();
}

MatrixXcd PoleBasis::solve_greens(const std::vector<int>& vertices, Execution& execution) const {
  if (on_level_) return on_level_->solve_greens(vertices, execution);
  MatrixXd B(static_cast<Index>(vertex_share_.size()), static_cast<Index>(vertices.size()));
  // L v = delta - share of the area: on a closed surface the right-hand side sums to 0. With boundary v = 0 there takes
  // the rest.
  if (closed())
    B.colwise() = -Eigen::Map<const VectorXd>(vertex_share_.data(), B.rows());
  else
    B.setZero();
  for (Index i = 0; i < B.cols(); ++i) B(vertices[i], i) += 1;
  const auto v = solver_->borrow(execution)->systems().solve(
      B, closed() ? solver::Condition::natural : solver::Condition::dirichlet,
      [&] { return forms::FluxTerms{.sources = B}; }, execution);
  return uv::parts_of_imaginary(surface(), samples_, v);
}

bool PoleBasis::is_place(int vertex, const std::vector<char>& allowed) const {
  return (allowed.empty() || allowed[vertex]) && is_certain(vertex) &&
         mesh::has_proper_star(surface(), half_edges(), vertex);
}

MatrixXcd PoleBasis::derivatives(const std::vector<int>& triangles) const {
  const auto count = held(structure_.harmonic.functions).cols();
  return 2 * uv::sampled_parts(surface(), {triangles, uv::values_on_sides(surface(), *sides_, harmonic(), triangles)},
                               MatrixXcd::Identity(count, count))
                 .M;
}

}  // namespace holomorph::tiling
