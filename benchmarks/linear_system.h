// SPDX-License-Identifier: GPL-3.0-or-later
// The linear systems that the benchmarks of solvers solve.
#pragma once

#include <Eigen/Core>
#include <chrono>
#include <random>

#include "forms/laplacian.h"
#include "mesh/delaunay.h"
#include "mesh/intrinsic_surface.h"

namespace holomorph::benchmarks {

inline double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// The cotan Laplacian of the surface's triangles, or of the intrinsic Delaunay triangulation.
inline solver::Laplacian assembled(const mesh::Surface& surface, bool delaunay) {
  Execution silent;
  auto triangulation = mesh::intrinsic_triangulation(surface, mesh::half_edges(surface, silent), silent.workers());
  if (delaunay) mesh::make_delaunay(triangulation, silent);
  const auto weights = mesh::cotangent_weights(triangulation, silent);
  triangulation.forget_metric();
  return forms::laplacian(triangulation.half_edges, weights, silent);
}

/// Columns of sum 0, as those of d* eta are.
inline Eigen::MatrixXd right_hand_sides(Eigen::Index n, int count) {
  std::mt19937_64 generator(1);
  std::normal_distribution<double> normal;
  Eigen::MatrixXd B = Eigen::MatrixXd::NullaryExpr(n, count, [&] { return normal(generator); });
  return B.rowwise() - B.colwise().mean();
}

}  // namespace holomorph::benchmarks
