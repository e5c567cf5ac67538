// SPDX-License-Identifier: GPL-3.0-or-later
// progressive_mesh FILE...: for each mesh one line of JSON with the seconds of the two orders of holomorph's
// progressive mesh (from the surface's arrays to base and splits), of rebuilding the original from them, and of
// OpenMesh's Decimater with quadrics, normal check and progressive-mesh records, and of meshoptimizer's simplifier,
// which keeps no records, both down to the same number of faces.
#include <meshoptimizer.h>

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModNormalFlippingT.hh>
#include <OpenMesh/Tools/Decimater/ModProgMeshT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <vector>

#include "mesh/io/read.h"
#include "mesh/make_surface.h"
#include "progressive/refinement.h"
#include "progressive/simplify.h"

namespace {

using namespace holomorph;
using OpenMesh::Decimater::DecimaterT;
using OpenMesh::Decimater::ModNormalFlippingT;
using OpenMesh::Decimater::ModProgMeshT;
using OpenMesh::Decimater::ModQuadricT;
using Mesh = OpenMesh::TriMesh_ArrayKernelT<>;

template <class Work>
double median_seconds(int runs, const Work& work) {
  std::vector<double> seconds;
  for (int i = 0; i < runs; ++i) {
    const auto start = std::chrono::steady_clock::now();
    work();
    seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  std::sort(seconds.begin(), seconds.end());
  return seconds[seconds.size() / 2];
}

Mesh openmesh(const mesh::Surface& surface) {
  Mesh mesh;
  std::vector<OpenMesh::VertexHandle> vertices;
  for (const auto& [x, y, z] : surface.polygons.vertices) {
    vertices.push_back(
        mesh.add_vertex(Mesh::Point(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z))));
  }
  for (const auto& [a, b, c] : surface.triangles) mesh.add_face(vertices[a], vertices[b], vertices[c]);
  mesh.request_face_normals();
  mesh.update_face_normals();
  return mesh;
}

// Only the decimater's own work is timed, not the construction of its mesh.
double openmesh_seconds(const mesh::Surface& surface, std::size_t faces_left, std::size_t& removed) {
  Mesh mesh = openmesh(surface);
  return median_seconds(1, [&] {
    DecimaterT<Mesh> decimater(mesh);
    ModQuadricT<Mesh>::Handle quadric;
    ModNormalFlippingT<Mesh>::Handle flipping;
    ModProgMeshT<Mesh>::Handle records;
    decimater.add(quadric);
    decimater.add(flipping);
    decimater.add(records);
    decimater.module(quadric).unset_max_err();
    decimater.module(flipping).set_max_normal_deviation(75);
    decimater.initialize();
    removed = decimater.decimate_to_faces(0, faces_left);
  });
}

double meshoptimizer_seconds(const mesh::Surface& surface, std::size_t faces_left, std::size_t& removed) {
  std::vector<float> positions;
  for (const auto& point : surface.polygons.vertices) {
    for (const double x : point) positions.push_back(static_cast<float>(x));
  }
  std::vector<unsigned> corners;
  for (const auto& triangle : surface.triangles) corners.insert(corners.end(), triangle.begin(), triangle.end());
  std::vector<unsigned> result(corners.size());
  std::size_t left = 0;
  const double seconds = median_seconds(3, [&] {
    left = meshopt_simplify(result.data(), corners.data(), corners.size(), positions.data(), surface.vertex_count,
                            3 * sizeof(float), 3 * faces_left, 1.0f, 0, nullptr);
  });
  removed = surface.triangles.size() - left / 3;
  return seconds;
}

void measure(const char* path) {
  Execution silent;
  const mesh::Surface surface = mesh::make_surface(mesh::read(path), silent);
  const std::size_t faces = surface.triangles.size();
  const int runs = faces < 200000 ? 7 : 3;
  progressive::ProgressiveMesh mesh;
  const double quadric =
      median_seconds(runs, [&] { mesh = progressive_mesh(surface, progressive::Order::quadric, silent); });
  const double restore = median_seconds(runs, [&] { (void)restored(mesh); });
  const double independent =
      median_seconds(runs, [&] { (void)progressive_mesh(surface, progressive::Order::independent, silent); });
  std::size_t removed = 0;
  const double other = openmesh_seconds(surface, mesh.base.triangles.size(), removed);
  std::size_t removed_too = 0;
  const double meshoptimizer = meshoptimizer_seconds(surface, mesh.base.triangles.size(), removed_too);
  std::printf(
      "{\"mesh\": \"%s\", \"faces\": %zu, \"base_faces\": %zu, \"splits\": %zu, \"quadric\": %.4f, \"independent\": "
      "%.4f, "
      "\"restore\": %.4f, \"openmesh\": %.4f, \"openmesh_collapses\": %zu, \"meshoptimizer\": %.4f, "
      "\"meshoptimizer_removed\": %zu}\n",
      std::filesystem::path(path).stem().c_str(), faces, mesh.base.triangles.size(), mesh.splits.size(), quadric,
      independent, restore, other, removed, meshoptimizer, removed_too);
  std::fflush(stdout);
}

}  // namespace

int main(int count, char** paths) {
  try {
    for (int i = 1; i < count; ++i) measure(paths[i]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "progressive_mesh: %s\n", error.what());
    return 1;
  }
}
