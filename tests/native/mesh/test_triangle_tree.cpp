// Boxes around triangles against a look at all of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "mesh/make_surface.h"
#include "mesh/triangle_tree.h"

namespace holomorph::mesh {
namespace {

using Eigen::Vector3d;

// A torus of n x m quads around the z-axis, its ring thicker towards +x, turned by a rotation and moved.
Surface thick_ring(int n, int m, const Eigen::Matrix3d& rotation) {
  Polygons polygons;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < m; ++j) {
      const double a = 2 * std::numbers::pi * i / n, b = 2 * std::numbers::pi * j / m;
      const double thick = 1 + 0.4 * std::cos(a), ring = 3 + thick * std::cos(b);
      Vector3d p(ring * std::cos(a), ring * std::sin(a), thick * std::sin(b) * (1 + 0.3 * std::sin(b)));
      p = rotation * p + Vector3d(5, -3, 2);
      polygons.vertices.push_back({p.x(), p.y(), p.z()});
    }
  }
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < m; ++j) {
      for (const int v : {i * m + j, (i + 1) % n * m + j, (i + 1) % n * m + (j + 1) % m, i * m + (j + 1) % m})
        polygons.corner_vertices.push_back(v);
    }
  }
  for (std::size_t c = 0; c <= polygons.corner_vertices.size(); c += 4)
    polygons.face_offsets.push_back(static_cast<int>(c));
  Execution execution(1);
  return make_surface(std::move(polygons), execution);
}

Eigen::Matrix3d turned() {
  return (Eigen::AngleAxisd(0.7, Vector3d::UnitX()) * Eigen::AngleAxisd(-1.1, Vector3d(1, 2, 3).normalized()))
      .toRotationMatrix();
}

// A surface of one triangle of another.
Surface alone(const Surface& surface, int triangle) {
  Polygons polygons;
  for (const int v : surface.triangles[triangle]) polygons.vertices.push_back(surface.polygons.vertices[v]);
  polygons.corner_vertices.assign({0, 1, 2});
  polygons.face_offsets.assign({0, 3});
  Execution execution(1);
  return make_surface(std::move(polygons), execution);
}

TEST(TriangleTree, FindsWhatALookAtAllTrianglesFinds) {
  const Surface surface = thick_ring(16, 9, turned());
  const TriangleTree tree(surface);
  std::vector<TriangleTree> each;
  for (int t = 0; t < static_cast<int>(surface.triangles.size()); ++t) each.emplace_back(alone(surface, t));
  std::mt19937_64 numbers(5);
  const auto vector = [&] {
    Vector3d v;
    for (double& x : v) x = static_cast<double>(numbers() >> 11) * 0x1p-52 - 1.0;
    return v;
  };
  int met = 0;
  for (int i = 0; i < 200; ++i) {
    const Vector3d p = 5 * vector() + Vector3d(5, -3, 2), along = vector();
    const bool meets = std::ranges::any_of(each, [&](const TriangleTree& one) { return one.meets(p, along, 0.1); });
    EXPECT_EQ(tree.meets(p, along, 0.1), meets);
    met += meets ? 1 : 0;
  }
  EXPECT_GT(met, 20);
  EXPECT_LT(met, 180);
}

}  // namespace
}  // namespace holomorph::mesh
