#include "openmesh/progmesh_records.h"

#include <numeric>

#include "progressive/refinement.h"

namespace holomorph::openmesh {
namespace {

using OpenMesh::VertexHandle;

// The number of each handle: vertices of the base in their order, then those of the records, the last first.
std::vector<int> numbers(const std::vector<mesh::Triple>& base, std::size_t vertex_count,
                         const std::vector<ProgMeshRecord>& records) {
  std::vector<int> number(vertex_count, -1);
  for (const mesh::Triple& triangle : base) {
    for (const int v : triangle) number[v] = 0;
  }
  int next = 0;
  for (int& n : number) {
    if (n == 0) n = next++;
  }
  for (std::size_t i = records.size(); i-- > 0;) {
    const int v = records[i].v0.idx();
    if (v < 0 || v >= static_cast<int>(vertex_count) || number[v] >= 0) {
      throw InvalidMesh("record " + std::to_string(i) + " removes vertex " + std::to_string(v) +
                        ", which does not exist, is still in the mesh, or is removed twice");
    }
    number[v] = next++;
  }
  for (std::size_t v = 0; v < vertex_count; ++v) {
    if (number[v] < 0) throw InvalidMesh("vertex " + std::to_string(v) + " has no face, and no record removed it");
  }
  return number;
}

}  // namespace

std::vector<ProgMeshRecord> to_progmesh_records(const progressive::ProgressiveMesh& mesh) {
  std::vector<ProgMeshRecord> records;
  records.reserve(mesh.splits.size());
  for (std::size_t k = mesh.splits.size(); k-- > 0;) {
    const progressive::Split& split = mesh.splits[k];
    records.push_back({VertexHandle(mesh.base_vertex_count() + static_cast<int>(k)), VertexHandle(split.v_s),
                       VertexHandle(split.v_r), VertexHandle(split.v_l)});
  }
  return records;
}

progressive::ProgressiveMesh detail::from_records(const std::vector<mesh::Triple>& base,
                                                  const std::vector<std::array<double, 3>>& positions,
                                                  const std::vector<ProgMeshRecord>& records) {
  const std::vector<int> number = numbers(base, positions.size(), records);
  const auto at = [&](VertexHandle v) {
    if (v.idx() >= static_cast<int>(number.size())) {
      throw InvalidMesh("a record names vertex " + std::to_string(v.idx()) + ", which does not exist");
    }
    return v.is_valid() ? number[v.idx()] : -1;
  };
  progressive::ProgressiveMesh mesh;
  mesh.vertex_index.resize(number.size());
  mesh.positions.resize(number.size());
  for (std::size_t v = 0; v < number.size(); ++v) {
    mesh.vertex_index[number[v]] = static_cast<int>(v);
    mesh.positions[number[v]] = positions[v];
  }
  std::vector<mesh::Triple> triangles = base;
  for (mesh::Triple& triangle : triangles) {
    for (int& v : triangle) v = number[v];
  }
  std::size_t triangle_count = triangles.size();
  for (auto record = records.rbegin(); record != records.rend(); ++record) {
    mesh.splits.push_back({at(record->v1), at(record->vr), at(record->vl), 0, 0});
    triangle_count += record->vl.is_valid() + record->vr.is_valid();
  }
  progressive::set_base(mesh, triangles, positions.size() - records.size());
  mesh.triangle_index.resize(triangle_count);
  std::iota(mesh.triangle_index.begin(), mesh.triangle_index.end(), 0);
  progressive::check(mesh);
  return mesh;
}

}  // namespace holomorph::openmesh
