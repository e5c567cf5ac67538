// OpenMesh meshes of every kind, made by the tests.
#pragma once

// Readers and writers before meshes, as OpenMesh asks for; none is used here.
#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <cmath>
#include <numbers>
#include <vector>

namespace holomorph::tests {

struct FloatTraits : OpenMesh::DefaultTraits {};
struct StatusTraits : OpenMesh::DefaultTraitsDouble {
  using TexCoord2D = OpenMesh::Vec2d;
  VertexAttributes(OpenMesh::Attributes::Status);
  EdgeAttributes(OpenMesh::Attributes::Status);
  FaceAttributes(OpenMesh::Attributes::Status);
};
using FloatTriangles = OpenMesh::TriMesh_ArrayKernelT<FloatTraits>;
using DoubleTriangles = OpenMesh::TriMesh_ArrayKernelT<StatusTraits>;
using FloatPolygons = OpenMesh::PolyMesh_ArrayKernelT<FloatTraits>;
using DoublePolygons = OpenMesh::PolyMesh_ArrayKernelT<StatusTraits>;

template <class Mesh>
using Vertices = std::vector<typename Mesh::VertexHandle>;

/// An n x m grid on a torus of revolution; a triangle mesh cuts its quads. @param rows how many of its m rows have
/// faces: all, or fewer for a tube with two boundary loops, whose other vertices are isolated
template <class Mesh>
Mesh torus(int n, int m, int rows) {
  Mesh mesh;
  for (int j = 0; j < m; ++j) {
    for (int i = 0; i < n; ++i) {
      const double a = 2 * std::numbers::pi * i / n, b = 2 * std::numbers::pi * j / m, r = 2 + std::cos(b);
      typename Mesh::Point point;
      point[0] = static_cast<typename Mesh::Scalar>(r * std::cos(a));
      point[1] = static_cast<typename Mesh::Scalar>(r * std::sin(a));
      point[2] = static_cast<typename Mesh::Scalar>(std::sin(b));
      mesh.add_vertex(point);
    }
  }
  const auto at = [&](int i, int j) { return typename Mesh::VertexHandle(i % n + n * (j % m)); };
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < n; ++i) mesh.add_face(Vertices<Mesh>{at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
  }
  return mesh;
}

template <class Mesh>
Mesh torus(int n = 8, int m = 6) {
  return torus<Mesh>(n, m, m);
}

}  // namespace holomorph::tests
