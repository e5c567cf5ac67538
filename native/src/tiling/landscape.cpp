#include "tiling/landscape.h"

#include <algorithm>

#include "mesh/intrinsic_triangulation.h"
#include "structure/invariants.h"

namespace holomorph::tiling {
namespace {

constexpr int kBlock = 32;  // poles solved for at a time

}  // namespace

Landscape::Landscape(std::shared_ptr<const mesh::Surface> surface, const structure::Options& options,
                     Execution& execution, std::vector<int> samples)
    : samples_(std::move(samples)) {
  structure_.surface = std::move(surface);
  half_edges_ = mesh::half_edges(*structure_.surface, execution);
  auto triangulation = mesh::intrinsic_triangulation(*structure_.surface, half_edges_.copy(execution.workers()),
                                                     execution.workers());
  weights_ = mesh::cotangent_weights(triangulation, execution);
  lengths_ = std::move(triangulation.lengths);
  vertex_share_ = mesh::vertex_areas(*structure_.surface, lengths_);
  area_ = 0;
  for (const double a : vertex_share_) area_ += a;
  for (double& a : vertex_share_) a /= area_;

  sides_.emplace(*structure_.surface);

  structure_.topology = structure::find_topology(*structure_.surface, half_edges_, execution);
  const auto& topology = structure_.topology;
  const int natural = topology.families.natural;
  const auto classes = structure::harmonic_classes(topology, half_edges_,
                                                   topology::first_forms(topology.classes, natural, natural));
  structure_.memory = structure::plan_memory(
      {structure_.surface->vertex_count, static_cast<std::int64_t>(structure_.surface->edges.size()),
       topology.families.count() + kBlock},
      options.solver, options.memory_limit, structure::Keeping::all);
  systems_ = std::make_unique<structure::HarmonicSystems>(
      half_edges_, weights_, mesh::boundary_vertices(topology.boundary), structure_.memory.choice, execution);
  if (samples_.empty()) samples_ = uv::sample_triangles(*structure_.surface);
  harmonic_.classes = topology.classes;
  if (natural > 0) {
    structure_.functions = systems_->solve(classes, natural, structure_.memory.block, execution).functions;
    structure::complete(half_edges_, weights_, classes, structure_, execution);
    harmonic_.functions.swap(structure_.functions);
    holomorphic_ = uv::sampled_parts(*structure_.surface,
                                     {samples_, uv::values_on_sides(*structure_.surface, *sides_, harmonic_, samples_)},
                                     structure_.differentials);
  } else {
    holomorphic_.M.resize(static_cast<Eigen::Index>(samples_.size()), 0);
    holomorphic_.N = holomorphic_.M;
  }
}

Eigen::MatrixXcd Landscape::poles(const std::vector<int>& vertices, Execution& execution) {
  std::vector<int> missing;
  for (const int v : vertices) {
    if (!pole_parts_.contains(v)) missing.push_back(v);
  }
  std::sort(missing.begin(), missing.end());
  missing.erase(std::unique(missing.begin(), missing.end()), missing.end());
  for (std::size_t first = 0; first < missing.size(); first += kBlock) {
    const auto end = std::min(first + kBlock, missing.size());
    solve_for({missing.begin() + static_cast<std::ptrdiff_t>(first), missing.begin() + static_cast<std::ptrdiff_t>(end)},
              execution);
  }
  Eigen::MatrixXcd parts(static_cast<Eigen::Index>(samples_.size()), static_cast<Eigen::Index>(vertices.size()));
  for (Eigen::Index i = 0; i < parts.cols(); ++i) parts.col(i) = pole_parts_.at(vertices[i]);
  return parts;
}

void Landscape::solve_for(const std::vector<int>& vertices, Execution& execution) {
  Eigen::MatrixXd B(static_cast<Eigen::Index>(vertex_share_.size()), static_cast<Eigen::Index>(vertices.size()));
  if (closed())
    B.colwise() = -Eigen::Map<const Eigen::VectorXd>(vertex_share_.data(), B.rows());
  else
    B.setZero();
  for (Eigen::Index i = 0; i < B.cols(); ++i) B(vertices[i], i) += 1;
  const auto v = systems_->solver().solve(
      B, closed() ? solver::Condition::natural : solver::Condition::dirichlet, execution);
  const Eigen::MatrixXcd parts = uv::parts_of_imaginary(*structure_.surface, samples_, v);
  for (Eigen::Index i = 0; i < parts.cols(); ++i) pole_parts_.emplace(vertices[i], parts.col(i));
}

Eigen::MatrixXcd Landscape::derivatives(const std::vector<int>& triangles) const {
  const auto count = harmonic_.functions.cols();
  return 2 * uv::sampled_parts(surface(), {triangles, uv::values_on_sides(surface(), *sides_, harmonic_, triangles)},
                               Eigen::MatrixXcd::Identity(count, count))
                 .M;
}

}  // namespace holomorph::tiling
