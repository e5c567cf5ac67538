#include "tiling/landscape.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mesh/triangle_geometry.h"
#include "tiling/flow.h"
#include "uv/vector_fields.h"

namespace holomorph::tiling {
namespace {

constexpr int kBlock = 32;  // poles solved for at a time
// Beyond this weight less than nine digits of a flux are certain.
constexpr double kUncertain = 1e7;

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

Landscape::Landscape(std::shared_ptr<const mesh::Surface> surface, const structure::Options& options,
                     Execution& execution)
    : samples_(uv::sample_triangles(*surface)) {
  structure_.surface = std::move(surface);
  solve(options, execution);
}

Landscape::Landscape(std::shared_ptr<const mesh::Surface> surface, const structure::Options& options,
                     std::unique_ptr<Landscape> on_level, const CoarseLevel& level, Execution& execution)
    : on_level_(std::move(on_level)), level_vertex_(level.collapsed) {
  structure_.surface = std::move(surface);
  const std::vector<int> triangle_at = largest_triangles(this->surface());
  const mesh::Surface& coarse = on_level_->surface();
  for (const int t : on_level_->samples()) samples_.push_back(triangle_at[level.vertex[coarse.triangles[t][0]]]);
  // A (e_x + i e_y) there is the nearest to that here where A is multiplied by the product of the frames.
  const Eigen::MatrixXcd there = uv::tangent_frames(coarse, on_level_->samples()),
                         here = uv::tangent_frames(this->surface(), samples_);
  from_level_ = (here.conjugate().cwiseProduct(there)).colwise().sum().transpose() / 2;
  solve(options, execution);
}

void Landscape::solve(const structure::Options& options, Execution& execution) {
  discretisation_ = mesh::on_input(surface(), mesh::half_edges(surface(), execution), execution);
  discretisation_.errors = {};  // no bounds are wanted
  const mesh::HalfEdges& half_edges = discretisation_.half_edges;
  uncertain_ = uncertain_vertices(surface(), discretisation_.weights);
  vertex_share_ = mesh::vertex_areas(surface(), discretisation_.lengths);
  for (const double a : vertex_share_) area_ += a;
  for (double& a : vertex_share_) a /= area_;
  sides_.emplace(surface());

  structure_.topology = structure::find_topology(surface(), half_edges, execution);
  const auto& topology = structure_.topology;
  const int natural = topology.families.natural;
  structure_.harmonic.functions = std::make_shared<const forms::RowMajorMatrix>(surface().vertex_count, 0);
  holomorphic_.M.resize(static_cast<Eigen::Index>(samples_.size()), 0);
  holomorphic_.N = holomorphic_.M;
  if (natural == 0 && on_level_) return;
  const int pole_columns = on_level_ ? 0 : kBlock;
  solver_ = std::make_shared<structure::HarmonicSolver>(discretisation_, topology.families.count() + pole_columns,
                                                        options, execution);
  if (natural > 0) {
    structure_.harmonic = structure::harmonic_forms(surface(), topology, *solver_, execution);
    structure_.differentials = structure_.holomorphic().differentials;
    // Maps of polygons have triangles of their own (closed_maps.h), and poles are solved for on the level.
    if (on_level_ && surface().has_diagonals()) solver_.reset();
    const auto values = uv::values_on_sides(surface(), *sides_, harmonic(), samples_);
    holomorphic_ = uv::sampled_parts(surface(), {samples_, values}, structure_.differentials);
  }
}

Eigen::MatrixXcd Landscape::poles(const std::vector<int>& vertices, Execution& execution, int every) {
  const auto wanted = Eigen::seq(0, Eigen::last, every);
  if (on_level_) {
    std::vector<int> there;
    for (const int v : vertices) there.push_back(level_vertex_[v]);
    return from_level_(wanted).asDiagonal() * on_level_->poles(there, execution, every);
  }
  std::vector<int> missing;
  for (const int v : vertices) {
    if (!pole_parts_.contains(v)) missing.push_back(v);
  }
  std::sort(missing.begin(), missing.end());
  missing.erase(std::unique(missing.begin(), missing.end()), missing.end());
  for (std::size_t first = 0; first < missing.size(); first += kBlock) {
    const auto end = std::min(first + kBlock, missing.size());
    solve_for(
        {missing.begin() + static_cast<std::ptrdiff_t>(first), missing.begin() + static_cast<std::ptrdiff_t>(end)},
        execution);
  }
  const auto rows = (static_cast<Eigen::Index>(samples_.size()) + every - 1) / every;
  Eigen::MatrixXcd parts(rows, static_cast<Eigen::Index>(vertices.size()));
  for (Eigen::Index i = 0; i < parts.cols(); ++i) parts.col(i) = pole_parts_.at(vertices[i])(wanted);
  return parts;
}

void Landscape::forget_poles() {
  if (on_level_) on_level_->forget_poles();
  pole_parts_.clear();
}

void Landscape::solve_for(const std::vector<int>& vertices, Execution& execution) {
  Eigen::MatrixXd B(static_cast<Eigen::Index>(vertex_share_.size()), static_cast<Eigen::Index>(vertices.size()));
  if (closed())
    B.colwise() = -Eigen::Map<const Eigen::VectorXd>(vertex_share_.data(), B.rows());
  else
    B.setZero();
  for (Eigen::Index i = 0; i < B.cols(); ++i) B(vertices[i], i) += 1;
  const auto v = solver_->systems().solve(
      B, closed() ? solver::Condition::natural : solver::Condition::dirichlet,
      [&] { return forms::FluxTerms{.sources = B}; }, execution);
  const Eigen::MatrixXcd parts = uv::parts_of_imaginary(*structure_.surface, samples_, v);
  for (Eigen::Index i = 0; i < parts.cols(); ++i) pole_parts_.emplace(vertices[i], parts.col(i));
}

Eigen::MatrixXcd Landscape::derivatives(const std::vector<int>& triangles) const {
  const auto count = structure_.harmonic.functions->cols();
  return 2 * uv::sampled_parts(surface(), {triangles, uv::values_on_sides(surface(), *sides_, harmonic(), triangles)},
                               Eigen::MatrixXcd::Identity(count, count))
                 .M;
}

}  // namespace holomorph::tiling
