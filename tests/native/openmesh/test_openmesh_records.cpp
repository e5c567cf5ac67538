#include <gtest/gtest.h>

#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModProgMeshT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>
#include <algorithm>

#include "open_meshes.h"
#include "openmesh/progmesh_records.h"
#include "progressive/refinement.h"
#include "progressive/simplify.h"

namespace holomorph::openmesh {
namespace {

using namespace holomorph::tests;
using mesh::Triple;
using OpenMesh::VertexHandle;
using Mesh = DoubleTriangles;

// Triangles whichever corner comes first, in whatever order.
std::vector<Triple> sorted(std::vector<Triple> triangles) {
  for (Triple& t : triangles) std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

std::vector<Triple> triangles_of(const mesh::Polygons& polygons) {
  std::vector<Triple> triangles;
  for (std::size_t c = 0; c < polygons.corner_vertices.size(); c += 3) {
    const int* v = &polygons.corner_vertices[c];
    triangles.push_back({v[0], v[1], v[2]});
  }
  return sorted(triangles);
}

std::vector<Triple> triangles_of(const Mesh& mesh) {
  std::vector<Triple> triangles;
  for (auto f = mesh.faces_begin(); f != mesh.faces_end(); ++f) {
    auto fv = mesh.cfv_iter(*f);
    const int a = (fv++)->idx(), b = (fv++)->idx();
    triangles.push_back({a, b, fv->idx()});
  }
  return sorted(triangles);
}

Mesh::Point point(const std::array<double, 3>& p) { return {p[0], p[1], p[2]}; }

Mesh base_of(const progressive::ProgressiveMesh& progressive) {
  Mesh mesh;
  for (int v = 0; v < progressive.base_vertex_count(); ++v) mesh.add_vertex(point(progressive.positions[v]));
  for (const auto& [a, b, c] : progressive.base.triangles) {
    mesh.add_face(VertexHandle(a), VertexHandle(b), VertexHandle(c));
  }
  return mesh;
}

struct Case {
  int rows;
  progressive::Order order;
};

class ProgMeshRecords : public testing::TestWithParam<Case> {
 protected:
  Execution execution_{1};
  Mesh mesh_ = torus<Mesh>(8, 6, GetParam().rows);
  progressive::ProgressiveMesh progressive_ =
      progressive::progressive_mesh(*to_surface(mesh_, execution_).surface, GetParam().order, execution_);
};
INSTANTIATE_TEST_SUITE_P(Meshes, ProgMeshRecords,
                         testing::Values(Case{6, progressive::Order::quadric}, Case{6, progressive::Order::independent},
                                         Case{3, progressive::Order::quadric},
                                         Case{3, progressive::Order::independent}),
                         [](const auto& info) {
                           return std::string(info.param.rows == 6 ? "Torus" : "Tube") +
                                  (info.param.order == progressive::Order::quadric ? "Quadric" : "Independent");
                         });

TEST_P(ProgMeshRecords, ReplayedByOpenMeshGiveOurLevels) {
  const auto records = to_progmesh_records(progressive_);
  ASSERT_EQ(records.size(), progressive_.splits.size());
  ASSERT_GT(records.size(), 10U);
  Mesh mesh = base_of(progressive_);
  int made = 0;
  for (auto r = records.rbegin(); r != records.rend(); ++r) {
    const VertexHandle v0 = mesh.add_vertex(point(progressive_.positions[r->v0.idx()]));
    ASSERT_EQ(v0, r->v0);
    mesh.vertex_split(v0, r->v1, r->vl, r->vr);
    ASSERT_EQ(triangles_of(mesh), triangles_of(progressive::level(progressive_, ++made))) << "after split " << made;
  }
}

TEST_P(ProgMeshRecords, ComeBackAsTheSameSplits) {
  Mesh mesh = base_of(progressive_);
  for (int v = mesh.n_vertices(); v < progressive_.vertex_count(); ++v)
    mesh.add_vertex(point(progressive_.positions[v]));
  const auto back = from_progmesh_records(mesh, to_progmesh_records(progressive_));
  EXPECT_EQ(back.positions, progressive_.positions);
  ASSERT_EQ(back.splits.size(), progressive_.splits.size());
  for (std::size_t k = 0; k < back.splits.size(); ++k) {
    EXPECT_EQ(back.splits[k].v_s, progressive_.splits[k].v_s);
    EXPECT_EQ(back.splits[k].v_l, progressive_.splits[k].v_l);
    EXPECT_EQ(back.splits[k].v_r, progressive_.splits[k].v_r);
  }
}

TEST_P(ProgMeshRecords, OfOpenMeshsDecimaterRestoreItsMesh) {
  Mesh decimated = mesh_;
  decimated.delete_isolated_vertices();
  decimated.garbage_collection();
  const auto before = triangles_of(decimated);
  OpenMesh::Decimater::DecimaterT<Mesh> decimater(decimated);
  OpenMesh::Decimater::ModQuadricT<Mesh>::Handle quadric;
  OpenMesh::Decimater::ModProgMeshT<Mesh>::Handle recorder;
  decimater.add(quadric);
  decimater.add(recorder);
  decimater.initialize();
  ASSERT_GT(decimater.decimate(20), 5U);
  const auto& records = decimater.module(recorder).infolist();
  const auto made = from_progmesh_records(decimated, records);
  EXPECT_EQ(made.splits.size(), records.size());
  std::vector<Triple> finest = triangles_of(progressive::level(made, static_cast<int>(made.splits.size())));
  for (Triple& t : finest) {
    for (int& v : t) v = made.vertex_index[v];
  }
  EXPECT_EQ(sorted(finest), before);
}

TEST_P(ProgMeshRecords, ThatDoNotFitAreRefused) {
  Mesh mesh = base_of(progressive_);
  for (int v = mesh.n_vertices(); v < progressive_.vertex_count(); ++v)
    mesh.add_vertex(point(progressive_.positions[v]));
  const auto records = to_progmesh_records(progressive_);
  const auto refused = [&](auto change) {
    auto changed = records;
    change(changed);
    EXPECT_THROW(from_progmesh_records(mesh, changed), InvalidMesh);
  };
  refused([](auto& list) { list.pop_back(); });                       // a vertex that nothing removed
  refused([](auto& list) { list.push_back(list.back()); });           // removed twice
  refused([](auto& list) { list[2].v0 = VertexHandle(0); });          // still there
  refused([](auto& list) { list[2].v0 = VertexHandle(); });           // none
  refused([](auto& list) { list[2].v1 = VertexHandle(1000); });       // none
  refused([](auto& list) { std::swap(list.front(), list.back()); });  // not in their order
}

TEST(ProgMeshRecordsOfPolygons, AreRefused) {
  EXPECT_THROW(from_progmesh_records(torus<DoublePolygons>(), std::vector<ProgMeshRecord>{}), InvalidMesh);
}

}  // namespace
}  // namespace holomorph::openmesh
