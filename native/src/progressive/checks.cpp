#include "progressive/checks.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

#include "base/errors.h"
#include "mesh/make_surface.h"
#include "progressive/refinement.h"

namespace holomorph::progressive {
namespace {

void require(bool valid, const std::string& what) {
  if (!valid) throw InvalidMesh("the progressive mesh is damaged: " + what);
}

void check_permutation(const std::vector<int>& index, const char* what) {
  std::vector<char> found(index.size(), 0);
  for (const int i : index) {
    require(i >= 0 && static_cast<std::size_t>(i) < index.size() && !found[i],
            std::string(what) + " are not a permutation");
    found[i] = 1;
  }
}

// Returns the polygon of each triangle of the original. Triangles are numbered polygon by polygon, and a polygon of n
// corners has n - 2.
std::vector<int> polygons_of_triangles(const ProgressiveMesh& mesh) {
  const auto& offsets = mesh.face_offsets;
  require(offsets.front() == 0, "the first polygon does not begin at corner 0");
  std::vector<int> polygon;
  for (std::size_t f = 0; f + 1 < offsets.size(); ++f) {
    const std::int64_t size = std::int64_t{offsets[f + 1]} - offsets[f];
    require(size >= 3 && size - 2 <= static_cast<std::int64_t>(mesh.triangle_index.size() - polygon.size()),
            "polygon " + std::to_string(f) + " does not fit its triangles");
    polygon.insert(polygon.end(), static_cast<std::size_t>(size - 2), static_cast<int>(f));
  }
  require(polygon.size() == mesh.triangle_index.size(), "there are more triangles than the polygons have");
  return polygon;
}

// Each corner of a polygon occurs, always at the same vertex, in triangles of its own polygon only.
void check_corners(const ProgressiveMesh& mesh, const std::vector<Triple>& triangles) {
  std::vector<int> polygon;
  if (!mesh.face_offsets.empty()) polygon = polygons_of_triangles(mesh);
  const int corner_count = polygon.empty() ? 3 * mesh.triangle_count() : mesh.face_offsets.back();
  const std::vector<Triple> corners = original_corners(mesh);
  std::vector<int> vertex(static_cast<std::size_t>(corner_count), -1);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const int original = mesh.triangle_index[t];
    const int first = polygon.empty() ? 3 * original : mesh.face_offsets[polygon[original]];
    const int last = polygon.empty() ? first + 3 : mesh.face_offsets[polygon[original] + 1];
    for (int i = 0; i < 3; ++i) {
      const int c = corners[t][i];
      require(c >= first && c < last, "a triangle has a corner from another polygon");
      require(vertex[c] < 0 || vertex[c] == triangles[t][i], "corner " + std::to_string(c) + " has two vertices");
      vertex[c] = triangles[t][i];
    }
  }
  for (const int v : vertex) require(v >= 0, "a polygon corner is in no triangle");
}

}  // namespace

void set_base(ProgressiveMesh& mesh, const std::vector<Triple>& triangles, std::size_t vertex_count) {
  require(vertex_count + mesh.splits.size() <= mesh.positions.size(), "there are more splits than vertices");
  mesh::Polygons polygons{
      {mesh.positions.begin(), mesh.positions.begin() + static_cast<std::ptrdiff_t>(vertex_count)}, {}, {0}};
  for (const Triple& t : triangles) {
    polygons.corner_vertices.insert(polygons.corner_vertices.end(), t.begin(), t.end());
    polygons.face_offsets.push_back(static_cast<int>(polygons.corner_vertices.size()));
  }
  Execution execution;
  try {
    mesh.base = make_surface(std::move(polygons), execution);
  } catch (const Error& error) {
    require(false, std::string("its base: ") + error.what());
  }
  require(mesh.base.repairs.isolated_vertices.empty(), "its base has isolated vertices");
  require(mesh.base.repairs.reversed_faces.empty(), "the triangles of its base are not oriented alike");
}

void check(const ProgressiveMesh& mesh) {
  // Sides of triangles are numbered 4 t + i (corner_table.h).
  constexpr std::size_t kMost = std::numeric_limits<int>::max() / 4;
  for (const std::size_t count : {mesh.positions.size(), mesh.triangle_index.size(), mesh.face_offsets.size()})
    require(count <= kMost, "it has too many elements for 32 bits");
  require(mesh.vertex_index.size() == mesh.positions.size(), "there are not as many vertex indices as positions");
  require(mesh.triangle_corners.empty() || mesh.triangle_corners.size() == mesh.triangle_index.size(),
          "there are not as many triangle corners as triangles");
  for (const auto& p : mesh.positions)
    require(std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]), "a position is not finite");
  check_permutation(mesh.vertex_index, "the vertex indices");
  check_permutation(mesh.triangle_index, "the triangle indices");
  // Counts come first: all that follows indexes by them.
  std::size_t count = mesh.base.triangles.size();
  for (const Split& split : mesh.splits) count += (split.v_l >= 0) + (split.v_r >= 0);
  require(count == mesh.triangle_index.size(), "the splits do not make as many triangles as there are");
  Refinement refinement(mesh, static_cast<int>(mesh.splits.size()));
  // Each split checks itself, and a valid mesh stays valid. So all levels are valid.
  while (refinement.splits_made() < static_cast<int>(mesh.splits.size())) refinement.split();
  check_corners(mesh, refinement.triangles());
  if (mesh.face_offsets.empty()) return;
  Execution execution;
  try {
    (void)make_surface(restored(mesh), execution);
  } catch (const Error& error) {
    require(false, std::string("its polygons: ") + error.what());
  }
}

}  // namespace holomorph::progressive
