#include "multiresolution/paper_levels.h"

#include <algorithm>
#include <numeric>

#include "base/errors.h"
#include "mesh/triangle_geometry.h"
#include "multiresolution/polygon_paths.h"
#include "progressive/simplify.h"
#include "progressive/single_edges.h"

namespace holomorph::multiresolution {
namespace {

using progressive::ProgressiveMesh;

// Least area of a triangle of a level over the sum of its squared sides, which is 0.144 for an equilateral one. All its
// cotangents shrink by one factor, so that the matrix remains positive semi-definite.
constexpr double kLeastLevelArea = 1e-3;
// Part of the time of paper_levels that edge collapses take, for the progress function.
constexpr double kCollapsing = 0.8;

// Cotangents / 2 of a triangle's angles, entry i opposite side i from corner i to the next.
std::array<double, 3> side_weights(const std::array<std::array<double, 3>, 3>& corners) {
  std::array<double, 3> length;
  for (int i = 0; i < 3; ++i) length[i] = mesh::distance(corners[i], corners[(i + 1) % 3]);
  const auto& [a, b, c] = length;
  const double area = std::max(mesh::triangle_area(a, b, c), kLeastLevelArea * (a * a + b * b + c * c));
  if (!(area > 0)) return {0, 0, 0};
  return {mesh::cotangent(a, b, c, area) / 2, mesh::cotangent(b, c, a, area) / 2, mesh::cotangent(c, a, b, area) / 2};
}

}  // namespace

PaperLevels paper_levels(const mesh::Surface& surface, Execution& execution) {
  if (surface.intrinsic()) {
    throw InvalidMesh(
        "the paper's solver needs positions, and this surface has edge lengths only; "
        "take one of auto, direct, multigrid");
  }
  PaperLevels levels;
  execution.part(0, kCollapsing);
  {
    const Execution::Within within(execution);
    levels.mesh =
        std::make_shared<const ProgressiveMesh>(progressive_mesh(surface, progressive::Order::quadric, execution));
  }
  const ProgressiveMesh& mesh = *levels.mesh;
  levels.splits = static_cast<int>(mesh.splits.size());
  levels.place.resize(mesh.vertex_index.size());
  for (std::size_t p = 0; p < levels.place.size(); ++p) levels.place[mesh.vertex_index[p]] = static_cast<int>(p);
  const auto flipped = progressive::with_single_edges(surface);
  const mesh::Surface& triangulation = flipped ? *flipped : surface;
  levels.triangles.reserve(mesh.triangle_index.size());
  for (const int t : mesh.triangle_index) {
    levels.triangles.push_back(triangulation.triangles[t]);
    for (int& v : levels.triangles.back()) v = levels.place[v];
  }

  topology::BaseBases base = topology::base_bases(mesh.base);
  levels.base_classes = std::move(base.classes);
  const std::vector<int> to_base = progressive::vertex_map(mesh, 0);
  std::vector<int> map(levels.place.size());
  for (std::size_t v = 0; v < map.size(); ++v) map[v] = to_base[levels.place[v]];
  levels.bases.classes = topology::pull_back_classes(mesh.base, levels.base_classes, triangulation, map);
  auto loops = topology::lift_loops(mesh, levels.splits, base.loops);
  for (auto& loop : loops) {
    for (int& v : loop) v = mesh.vertex_index[v];
  }
  if (flipped) values_of_diagonals(surface, *flipped, levels.bases.classes);
  levels.bases.loops = loops_of_half_edges(surface, triangulation, loops, execution);
  return levels;
}

PaperLevels paper_levels(const ProgressiveMesh& mesh, int splits, const mesh::Surface& level) {
  PaperLevels levels;
  levels.mesh = {std::shared_ptr<void>(), &mesh};
  levels.splits = splits;
  levels.place.resize(static_cast<std::size_t>(level.vertex_count));
  std::iota(levels.place.begin(), levels.place.end(), 0);
  levels.triangles.assign(level.triangles.begin(), level.triangles.end());
  levels.base_classes = topology::base_bases(mesh.base).classes;
  levels.bases = topology::lifted_bases(mesh, splits, level);
  return levels;
}

LevelSystem level_system(const PaperLevels& levels, int splits) {
  const ProgressiveMesh& mesh = *levels.mesh;
  const int n = mesh.base_vertex_count() + splits;
  const std::size_t triangle_count = mesh.base.triangles.size() + 2 * static_cast<std::size_t>(splits);
  const std::vector<int> to_level = progressive::vertex_map(mesh, splits), to_base = progressive::vertex_map(mesh, 0);
  LevelSystem system;
  system.faces = static_cast<std::int64_t>(triangle_count);

  std::vector<int> row(static_cast<std::size_t>(n));
  int next = 0;
  for (const int p : levels.place) {
    if (p < n) row[p] = next++;
  }
  for (const int p : levels.place) system.row_of_vertex.push_back(row[to_level[p]]);

  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(12 * triangle_count);
  system.B = Eigen::MatrixXd::Zero(n, levels.base_classes.form_count);
  for (std::size_t t = 0; t < triangle_count; ++t) {
    mesh::Triple v = levels.triangles[t];
    for (int& corner : v) corner = to_level[corner];
    const auto weights = side_weights({mesh.positions[v[0]], mesh.positions[v[1]], mesh.positions[v[2]]});
    for (int i = 0; i < 3; ++i) {
      const double weight = weights[i];
      const int tail = row[v[i]], head = row[v[(i + 1) % 3]];
      entries.insert(entries.end(),
                     {{tail, tail, weight}, {tail, head, -weight}, {head, head, weight}, {head, tail, -weight}});
      const int a = to_base[v[i]], b = to_base[v[(i + 1) % 3]];
      if (a == b) continue;
      const int edge = mesh::edge_between(mesh.base.edges, a, b);
      for (const auto& [form, value] : levels.base_classes.rows[edge]) {
        const double flux = weight * (a < b ? value : -value);
        system.B(head, form) -= flux;
        system.B(tail, form) += flux;
      }
    }
  }
  solver::Laplacian::Matrix L(n, n);
  L.setFromTriplets(entries.begin(), entries.end());
  system.L = {{L.outerIndexPtr(), L.outerIndexPtr() + n + 1},
              {L.innerIndexPtr(), L.innerIndexPtr() + L.nonZeros()},
              {L.valuePtr(), L.valuePtr() + L.nonZeros()}};
  return system;
}

}  // namespace holomorph::multiresolution
