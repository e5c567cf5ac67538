#include <gtest/gtest.h>

#include <limits>

#include "open_meshes.h"
#include "openmesh/surface_of_mesh.h"

namespace holomorph::openmesh {
namespace {

using OpenMesh::FaceHandle;
using OpenMesh::HalfedgeHandle;
using OpenMesh::VertexHandle;
using namespace holomorph::tests;

// Every element of the surface is the mesh's whose handle stands in its place.
template <class Mesh>
void expect_elements_match(const Mesh& mesh, const SurfaceOfMesh& part) {
  const auto& polygons = part.surface->polygons;
  for (std::size_t v = 0; v < part.vertices.size(); ++v) {
    for (int k = 0; k < 3; ++k) EXPECT_EQ(polygons.vertices[v][k], mesh.point(part.vertices[v])[k]);
  }
  for (std::size_t f = 0; f < part.faces.size(); ++f) {
    int c = polygons.face_offsets[f];
    for (auto fv = mesh.cfv_iter(part.faces[f]); fv.is_valid(); ++fv, ++c) {
      EXPECT_EQ(part.vertices[polygons.corner_vertices[c]], *fv);
      EXPECT_EQ(mesh.to_vertex_handle(part.corners[c]), *fv);
      EXPECT_EQ(mesh.face_handle(part.corners[c]), part.faces[f]);
    }
    EXPECT_EQ(c, polygons.face_offsets[f + 1]);
  }
  ASSERT_EQ(static_cast<int>(part.edges.size()), part.surface->polygon_edge_count);
  for (std::size_t e = 0; e < part.edges.size(); ++e) {
    const auto [low, high] = part.surface->edges[e];
    EXPECT_LT(low, high);
    EXPECT_EQ(mesh.from_vertex_handle(part.edges[e]), part.vertices[low]);
    EXPECT_EQ(mesh.to_vertex_handle(part.edges[e]), part.vertices[high]);
  }
}

template <class Mesh>
class OpenMeshSurface : public testing::Test {
 protected:
  Execution execution_{1};
};
using Meshes = testing::Types<FloatTriangles, DoubleTriangles, FloatPolygons, DoublePolygons>;
TYPED_TEST_SUITE(OpenMeshSurface, Meshes);

TYPED_TEST(OpenMeshSurface, HasTheElementsOfTheMesh) {
  const auto mesh = torus<TypeParam>();
  const auto part = to_surface(mesh, this->execution_);
  EXPECT_EQ(part.vertices.size(), mesh.n_vertices());
  EXPECT_EQ(part.faces.size(), mesh.n_faces());
  EXPECT_EQ(part.edges.size(), mesh.n_edges());
  EXPECT_TRUE(part.surface->repairs.reversed_faces.empty());
  expect_elements_match(mesh, part);
}

TYPED_TEST(OpenMeshSurface, PolygonsStayAsTheyAre) {
  const auto part = to_surface(torus<TypeParam>(), this->execution_);
  const int corners = TypeParam::is_trimesh() ? 3 : 4;
  for (std::size_t f = 0; f <= part.faces.size(); ++f) {
    EXPECT_EQ(part.surface->polygons.face_offsets[f], corners * static_cast<int>(f));
  }
  EXPECT_EQ(part.surface->triangles.size(), 96U);
}

TYPED_TEST(OpenMeshSurface, IsolatedVerticesAreLeftOutAndBoundariesKept) {
  const auto mesh = torus<TypeParam>(8, 6, 2);
  const auto part = to_surface(mesh, this->execution_);
  EXPECT_EQ(part.vertices.size(), 24U);
  EXPECT_TRUE(part.surface->repairs.isolated_vertices.empty());
  int boundary = 0;
  for (const auto h : part.edges) boundary += mesh.is_boundary(mesh.edge_handle(h));
  EXPECT_EQ(boundary, 16);
  expect_elements_match(mesh, part);
}

TYPED_TEST(OpenMeshSurface, DeletedFacesAreLeftOutAsAfterGarbageCollection) {
  auto mesh = torus<TypeParam>();
  mesh.request_face_status();
  mesh.request_edge_status();
  mesh.request_vertex_status();
  std::vector<FaceHandle> star;
  for (auto f = mesh.cvf_iter(VertexHandle(9)); f.is_valid(); ++f) star.push_back(*f);
  for (const FaceHandle f : star) mesh.delete_face(f, true);
  const auto part = to_surface(mesh, this->execution_);
  EXPECT_EQ(part.vertices.size(), mesh.n_vertices() - 1);
  EXPECT_LT(part.faces.size(), mesh.n_faces());
  expect_elements_match(mesh, part);

  mesh.garbage_collection();
  const auto collected = to_surface(mesh, this->execution_);
  EXPECT_EQ(collected.vertices.size(), part.vertices.size());
  EXPECT_EQ(collected.faces.size(), part.faces.size());
  EXPECT_EQ(collected.edges.size(), part.edges.size());
  expect_elements_match(mesh, collected);
}

TYPED_TEST(OpenMeshSurface, ComponentsKnowTheWholeMesh) {
  auto mesh = torus<TypeParam>(8, 6, 2);
  for (int v = 0; v < 3; ++v) mesh.set_point(VertexHandle(v + 40), mesh.point(VertexHandle(v)));
  mesh.add_face(VertexHandle(42), VertexHandle(40), VertexHandle(41));
  const auto parts = components(to_surface(mesh, this->execution_), this->execution_);
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(parts[1].vertices, (std::vector<VertexHandle>{VertexHandle(40), VertexHandle(41), VertexHandle(42)}));
  for (const auto& part : parts) expect_elements_match(mesh, part);
}

class OpenMeshRefusals : public testing::Test {
 protected:
  template <class Mesh>
  std::string message(const Mesh& mesh) {
    try {
      to_surface(mesh, execution_);
    } catch (const InvalidMesh& error) {
      return error.what();
    }
    return "";
  }

  Execution execution_{1};
  DoublePolygons mesh_ = torus<DoublePolygons>();
};

TEST_F(OpenMeshRefusals, PointsThatAreNotFinite) {
  mesh_.set_point(VertexHandle(5), {0, std::numeric_limits<double>::infinity(), 0});
  EXPECT_NE(message(mesh_).find("vertex 5"), std::string::npos) << message(mesh_);
  EXPECT_EQ(message(mesh_).find("numbered without"), std::string::npos);
  mesh_.add_vertex({0, 0, 0});
  EXPECT_NE(message(mesh_).find("numbered without deleted elements and isolated vertices"), std::string::npos);
}

TEST_F(OpenMeshRefusals, FansThatTouchAtAVertex) {
  DoublePolygons mesh;
  for (int v = 0; v < 5; ++v) mesh.add_vertex({std::cos(v), std::sin(v), 0.1 * v});
  mesh.add_face(VertexHandle(0), VertexHandle(1), VertexHandle(2));
  mesh.add_face(VertexHandle(0), VertexHandle(3), VertexHandle(4));
  EXPECT_NE(message(mesh), "");
}

TEST_F(OpenMeshRefusals, FacesOfDeletedVertices) {
  mesh_.status(VertexHandle(9)).set_deleted(true);
  EXPECT_EQ(message(mesh_), "face 0 has the deleted vertex 9");
}

TEST_F(OpenMeshRefusals, HalfEdgesThatCloseNoLoop) {
  const HalfedgeHandle first = mesh_.halfedge_handle(FaceHandle(3)), second = mesh_.next_halfedge_handle(first);
  mesh_.set_next_halfedge_handle(second, second);
  EXPECT_EQ(message(mesh_), "the half-edges of face 3 do not form a closed loop");
}

TEST_F(OpenMeshRefusals, EmptyMeshes) { EXPECT_NE(message(DoublePolygons()), ""); }

TEST_F(OpenMeshRefusals, MeshesThatChangedSince) {
  const auto part = to_surface(mesh_, execution_);
  require_unchanged(mesh_, part);
  mesh_.delete_face(FaceHandle(7), false);
  EXPECT_THROW(require_unchanged(mesh_, part), InvalidMesh);
  mesh_.garbage_collection();
  EXPECT_THROW(require_unchanged(mesh_, part), InvalidMesh);
  EXPECT_THROW(require_unchanged(DoublePolygons(), part), InvalidMesh);
}

}  // namespace
}  // namespace holomorph::openmesh
