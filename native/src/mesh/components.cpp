#include "mesh/components.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "mesh/intrinsic_surface.h"
#include "mesh/make_surface.h"

namespace holomorph::mesh {
namespace {

// The faces of each component, ascending.
std::vector<std::vector<int>> faces_by_component(const Surface& parent) {
  std::vector<std::vector<int>> faces(parent.component_count);
  for (int f = 0; f < static_cast<int>(parent.face_component.size()); ++f) faces[parent.face_component[f]].push_back(f);
  return faces;
}

// Takes components out of a surface, one after the other.
class Cutter {
 public:
  explicit Cutter(const Surface& parent) : parent_(parent), new_vertex_(parent.vertex_count, -1) {
    if (!parent.intrinsic()) return;
    reversed_.assign(parent.triangles.size(), 0);
    for (const int f : parent.repairs.reversed_faces) reversed_[f] = 1;
  }

  Component cut(std::vector<int> faces, Execution& execution) {
    Component part;
    part.face_index = std::move(faces);
    number(part);
    part.surface = parent_.intrinsic() ? intrinsic_part(part, execution) : polygon_part(part, execution);
    for (const int v : part.vertex_index) new_vertex_[v] = -1;
    return part;
  }

 private:
  void number(Component& part) {
    const Polygons& mesh = parent_.polygons;
    for (const int f : part.face_index) {
      for (auto c = mesh.face_offsets[f]; c < mesh.face_offsets[f + 1]; ++c) {
        part.corner_index.push_back(static_cast<int>(c));
        if (std::exchange(new_vertex_[mesh.corner_vertices[c]], 0) < 0)
          part.vertex_index.push_back(mesh.corner_vertices[c]);
      }
    }
    std::sort(part.vertex_index.begin(), part.vertex_index.end());
    for (std::size_t v = 0; v < part.vertex_index.size(); ++v) new_vertex_[part.vertex_index[v]] = static_cast<int>(v);
  }

  // From its triangles as given (before any was reversed), edges by name.
  Surface intrinsic_part(const Component& part, Execution& execution) const {
    std::vector<std::array<std::int64_t, 3>> triangles, names;
    std::vector<std::array<double, 3>> lengths;
    for (const int f : part.face_index) {
      Triple v = parent_.triangles[f], side = parent_.triangle_edges[f];
      if (reversed_[f]) std::swap(v[1], v[2]), std::swap(side[0], side[2]);
      std::array<std::int64_t, 3> vertices, name;
      std::array<double, 3> length;
      for (int i = 0; i < 3; ++i) {
        vertices[i] = new_vertex_[v[i]];
        name[i] = side[(i + 1) % 3];  // corner i lies opposite side i + 1
        length[i] = parent_.edge_lengths[side[(i + 1) % 3]];
      }
      triangles.push_back(vertices);
      names.push_back(name);
      lengths.push_back(length);
    }
    return make_intrinsic_surface(static_cast<int>(part.vertex_index.size()), triangles, lengths, names, execution);
  }

  Surface polygon_part(const Component& part, Execution& execution) const {
    const Polygons& mesh = parent_.polygons;
    Polygons polygons;
    for (const int v : part.vertex_index) polygons.vertices.push_back(mesh.vertices[v]);
    polygons.face_offsets.push_back(0);
    for (const int f : part.face_index) {
      for (auto c = mesh.face_offsets[f]; c < mesh.face_offsets[f + 1]; ++c)
        polygons.corner_vertices.push_back(new_vertex_[mesh.corner_vertices[c]]);
      polygons.face_offsets.push_back(static_cast<int>(polygons.corner_vertices.size()));
    }
    return make_surface(std::move(polygons), execution);
  }

  const Surface& parent_;
  std::vector<int> new_vertex_;  // in the part that is cut, else -1
  std::vector<char> reversed_;
};

}  // namespace

Component component(const Surface& parent, int which, Execution& execution) {
  return Cutter(parent).cut(std::move(faces_by_component(parent)[which]), execution);
}

std::vector<Component> components(const Surface& parent, Execution& execution) {
  std::vector<Component> parts;
  parts.reserve(parent.component_count);
  Cutter cutter(parent);
  for (std::vector<int>& faces : faces_by_component(parent)) parts.push_back(cutter.cut(std::move(faces), execution));
  return parts;
}

int euler_characteristic(const Surface& surface) {
  return surface.vertex_count - static_cast<int>(surface.repairs.isolated_vertices.size()) -
         static_cast<int>(surface.edges.size()) + static_cast<int>(surface.triangles.size());
}

int boundary_count(const Surface& surface) {
  // On each loop there are as many edges as vertices, and all but one join two parts of it.
  std::vector<int> part(surface.vertex_count);
  std::iota(part.begin(), part.end(), 0);
  const auto find = [&part](int v) {
    while (part[v] != v) v = part[v] = part[part[v]];
    return v;
  };
  int loops = 0;
  for (std::size_t e = 0; e < surface.edges.size(); ++e) {
    if (surface.edge_face_count[e] != 1) continue;
    const int a = find(surface.edges[e][0]), b = find(surface.edges[e][1]);
    if (a == b)
      ++loops;
    else
      part[std::max(a, b)] = std::min(a, b);
  }
  return loops;
}

std::string TopologicalType::text() const {
  return "genus " + std::to_string(genus) + " and " + std::to_string(boundary_count) + " boundary loops";
}

TopologicalType topological_type(const Surface& surface) {
  const int boundaries = boundary_count(surface);
  return {(2 - euler_characteristic(surface) - boundaries) / 2, boundaries};
}

}  // namespace holomorph::mesh
