#include "openmesh/surface_of_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <complex>
#include <map>
#include <utility>

#include "open_meshes.h"
#include "structure/primal_forms.h"
#include "uv/uv_map.h"

namespace holomorph::openmesh {
namespace {

using namespace holomorph::tests;
using Complex = std::complex<double>;
using UvArray = uv::UvArray;

template <class Mesh>
class OpenMeshAttributes : public testing::Test {
 protected:
  Execution execution_{1};
  Mesh mesh_ = torus<Mesh>(8, 6, 4);
  SurfaceOfMesh part_ = to_surface(mesh_, execution_);
};
using Meshes = testing::Types<FloatTriangles, DoubleTriangles, FloatPolygons, DoublePolygons>;
TYPED_TEST_SUITE(OpenMeshAttributes, Meshes);

TYPED_TEST(OpenMeshAttributes, UVsAreAtTheCornersOfFaces) {
  auto& mesh = this->mesh_;
  const auto& part = this->part_;
  UvArray uv(part.corners.size(), 2);
  for (Eigen::Index c = 0; c < uv.rows(); ++c) uv.row(c) << static_cast<double>(c), 0.5;
  write_uv(mesh, part, uv);
  for (std::size_t f = 0; f < part.faces.size(); ++f) {
    int c = part.surface->polygons.face_offsets[f];
    for (auto h = mesh.cfh_iter(part.faces[f]); h.is_valid(); ++h, ++c) {
      EXPECT_EQ(mesh.texcoord2D(*h), typename TypeParam::TexCoord2D(c, 0.5));
      EXPECT_EQ(mesh.to_vertex_handle(*h), part.vertices[part.surface->polygons.corner_vertices[c]]);
    }
  }
  EXPECT_THROW(write_uv(mesh, part, uv.topRows(3).eval()), InvalidMesh);
}

// df of the function f(v) = v^2 runs along half-edge 0 whichever way it goes.
TYPED_TEST(OpenMeshAttributes, FormsRunAlongHalfEdgeZero) {
  auto& mesh = this->mesh_;
  const auto& part = this->part_;
  const auto f = [](OpenMesh::VertexHandle v) { return static_cast<double>(v.idx()) * v.idx(); };
  Eigen::RowVectorXd values(part.surface->edges.size());
  for (Eigen::Index e = 0; e < values.size(); ++e) {
    const auto [low, high] = part.surface->edges[e];
    values[e] = f(part.vertices[high]) - f(part.vertices[low]);
  }
  OpenMesh::EPropHandleT<double> df;
  OpenMesh::EPropHandleT<Complex> theta;
  mesh.add_property(df);
  mesh.add_property(theta);
  write_form(mesh, part, values, df);
  write_form(mesh, part, (Complex(0, 2) * values).eval(), theta);
  int reversed = 0;
  for (auto e = mesh.edges_begin(); e != mesh.edges_end(); ++e) {
    const auto h = mesh.halfedge_handle(*e, 0);
    const auto from = mesh.from_vertex_handle(h), to = mesh.to_vertex_handle(h);
    EXPECT_EQ(mesh.property(df, *e), f(to) - f(from));
    EXPECT_EQ(mesh.property(theta, *e), Complex(0, 2) * (f(to) - f(from)));
    reversed += from.idx() > to.idx();
  }
  EXPECT_GT(reversed, 0);
  EXPECT_THROW(write_form(mesh, part, values.head(5).eval(), df), InvalidMesh);
}

TYPED_TEST(OpenMeshAttributes, SeamsAreFeaturesBesideThoseThatThereAre) {
  auto& mesh = this->mesh_;
  const auto& part = this->part_;
  mesh.request_edge_status();
  const auto own = mesh.edge_handle(part.edges[20]);
  mesh.status(own).set_feature(true);
  mark_seams(mesh, part, std::vector<int>{3, 11});
  int features = 0;
  for (auto e = mesh.edges_begin(); e != mesh.edges_end(); ++e) features += mesh.status(*e).feature();
  EXPECT_EQ(features, 3);
  for (const int e : {3, 11, 20}) EXPECT_TRUE(mesh.status(mesh.edge_handle(part.edges[e])).feature());
  const int beyond = part.surface->polygon_edge_count;
  EXPECT_THROW(mark_seams(mesh, part, std::vector<int>{4, beyond}), InvalidMesh);
  EXPECT_THROW(mark_seams(mesh, part, std::vector<int>{4, -1}), InvalidMesh);
  EXPECT_FALSE(mesh.status(mesh.edge_handle(part.edges[4])).feature());
}

TYPED_TEST(OpenMeshAttributes, NothingIsWrittenToAMeshThatChanged) {
  TypeParam other = torus<TypeParam>(6, 6);
  EXPECT_THROW(mark_seams(other, this->part_, std::vector<int>{0}), InvalidMesh);
  EXPECT_THROW(write_uv(other, this->part_, UvArray::Zero(this->part_.corners.size(), 2)), InvalidMesh);
  EXPECT_FALSE(other.has_halfedge_texcoords2D());
}

// Where an edge is not a seam, the texture coordinates of its ends agree on both sides; on both sides of a seam they
// differ by the same vector.
template <class Mesh>
void expect_seams_only(const Mesh& mesh, double tolerance) {
  for (auto e = mesh.edges_begin(); e != mesh.edges_end(); ++e) {
    if (mesh.is_boundary(*e)) continue;
    const auto h = mesh.halfedge_handle(*e, 0), back = mesh.halfedge_handle(*e, 1);
    const auto end = mesh.texcoord2D(h) - mesh.texcoord2D(mesh.prev_halfedge_handle(back));
    const auto begin = mesh.texcoord2D(mesh.prev_halfedge_handle(h)) - mesh.texcoord2D(back);
    EXPECT_NEAR((end - begin).norm(), 0, tolerance);
    if (!mesh.status(*e).feature()) {
      EXPECT_NEAR(end.norm(), 0, tolerance);
    }
  }
}

class BalancedMaps : public testing::Test {
 protected:
  // Maps the mesh, writes UVs and seams.
  template <class Mesh>
  structure::BalancedMap map(Mesh& mesh) {
    part_ = to_surface(mesh, execution_);
    auto map = structure::balanced_map(part_.surface, {}, execution_);
    write_uv(mesh, part_, map.uv);
    mark_seams(mesh, part_, map.structure.topology.seams);
    return map;
  }

  Execution execution_{1};
  SurfaceOfMesh part_;
};

TEST_F(BalancedMaps, OfATorusShiftAcrossSeamsAlone) {
  auto mesh = torus<DoublePolygons>();
  const auto result = map(mesh);
  EXPECT_EQ(result.coefficients.size(), 1);
  EXPECT_FALSE(result.structure.topology.seams.empty());
  EXPECT_NEAR(uv::frame(*part_.surface, result.uv, 0, execution_.workers()).area, 1, 1e-9);
  expect_seams_only(mesh, 1e-12);
}

TEST_F(BalancedMaps, OfATubeIsARectangle) {
  auto mesh = torus<DoubleTriangles>(8, 6, 4);
  const auto result = map(mesh);
  EXPECT_EQ(result.coefficients.imag().norm(), 0);
  EXPECT_NEAR(uv::frame(*part_.surface, result.uv, 0, execution_.workers()).area, 1, 1e-9);
  expect_seams_only(mesh, 1e-12);
}

TEST_F(BalancedMaps, OfASphereHasPunctures) {
  DoublePolygons mesh;
  const int n = 5;  // a cube's surface, cut into n x n squares a side
  std::map<std::array<int, 3>, OpenMesh::VertexHandle> at;
  const auto vertex = [&](std::array<int, 3> p) {
    const auto [place, is_new] = at.try_emplace(p);
    if (is_new) place->second = mesh.add_vertex({1.0 * p[0], 1.0 * p[1], 1.0 * p[2]});
    return place->second;
  };
  for (int axis = 0; axis < 3; ++axis) {
    for (const int level : {0, n}) {
      for (int k = 0; k < n * n; ++k) {
        Vertices<DoublePolygons> face;
        for (const auto& [u, v] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
          std::array<int, 3> p;
          p[axis] = level;
          p[(axis + 1) % 3] = k % n + u;
          p[(axis + 2) % 3] = k / n + v;
          face.push_back(vertex(p));
        }
        if (level == 0) std::reverse(face.begin(), face.end());
        mesh.add_face(face);
      }
    }
  }
  const auto result = map(mesh);
  EXPECT_EQ(result.structure.poles->chosen.vertices.size(), 2U);
  EXPECT_EQ(result.coefficients, Eigen::VectorXcd::Unit(1, 0));
  EXPECT_FALSE(result.structure.topology.seams.empty());
}

}  // namespace
}  // namespace holomorph::openmesh
