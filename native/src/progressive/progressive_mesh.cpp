#include "progressive/progressive_mesh.h"

#include <numeric>

namespace holomorph::progressive {

mesh::Polygons triangle_polygons(std::vector<std::array<double, 3>> vertices, const std::vector<Triple>& triangles) {
  mesh::Polygons polygons{std::move(vertices), {}, {}};
  polygons.corner_vertices.reserve(3 * triangles.size());
  polygons.face_offsets.reserve(triangles.size() + 1);
  for (const Triple& t : triangles) {
    polygons.face_offsets.push_back(static_cast<int>(polygons.corner_vertices.size()));
    for (const int v : t) polygons.corner_vertices.push_back(v);
  }
  polygons.face_offsets.push_back(static_cast<int>(polygons.corner_vertices.size()));
  return polygons;
}

namespace {

int triangles_of(const Split& split) { return (split.v_l >= 0) + (split.v_r >= 0); }

}  // namespace

std::int64_t triangle_count(const ProgressiveMesh& mesh, int splits) {
  auto triangles = static_cast<std::int64_t>(mesh.base.triangles.size());
  for (int k = 0; k < splits; ++k) triangles += triangles_of(mesh.splits[k]);
  return triangles;
}

int split_count(const ProgressiveMesh& mesh, std::int64_t triangle_count) {
  auto triangles = static_cast<std::int64_t>(mesh.base.triangles.size());
  int splits = 0;
  for (const Split& split : mesh.splits) {
    triangles += triangles_of(split);
    if (triangles > triangle_count) break;
    ++splits;
  }
  return splits;
}

std::vector<Triple> original_corners(const ProgressiveMesh& mesh) {
  if (!mesh.triangle_corners.empty()) return mesh.triangle_corners;
  std::vector<Triple> corners;
  corners.reserve(mesh.triangle_index.size());
  for (const int t : mesh.triangle_index) corners.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  return corners;
}

std::vector<int> vertex_map(const ProgressiveMesh& mesh, int splits) {
  std::vector<int> map(static_cast<std::size_t>(mesh.vertex_count()));
  std::iota(map.begin(), map.end(), 0);
  // v_s is older than v_t, so that its image is known.
  for (int k = splits; k < static_cast<int>(mesh.splits.size()); ++k)
    map[mesh.base_vertex_count() + k] = map[mesh.splits[k].v_s];
  return map;
}

}  // namespace holomorph::progressive
