#include "mesh/components.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "mesh/intrinsic_surface.h"
#include "mesh/make_surface.h"
#include "mesh/surface.h"

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
  explicit Cutter(const Surface& parent) : parent_(parent), parts_(parent.polygons) {}

  Component cut(std::vector<int> faces, Execution& execution) {
    PolygonPart part = parts_.take(std::move(faces));
    Surface surface;
    if (parent_.intrinsic()) {
      surface = intrinsic_part(part, execution);
    } else {
      surface.polygons = std::move(part.polygons);
      complete(surface, {Labels(part.vertex_index), Labels(part.face_index), parent_.component_count > 1}, execution);
    }
    return {std::move(surface), std::move(part.vertex_index), std::move(part.face_index), std::move(part.corner_index)};
  }

 private:
  // From its triangles as given, edges by name.
  Surface intrinsic_part(const PolygonPart& part, Execution& execution) const {
    std::vector<std::array<std::int64_t, 3>> triangles, names;
    std::vector<std::array<double, 3>> lengths;
    for (std::size_t i = 0; i < part.face_index.size(); ++i) {
      const int* v = &part.polygons.corner_vertices[3 * i];
      triangles.push_back({v[0], v[1], v[2]});
      names.emplace_back();
      lengths.emplace_back();
      const int f = part.face_index[i];
      for (int side = 0; side < 3; ++side) {
        const int corner = parent_.triangle_corners[f][(side + 2) % 3] - 3 * f;  // opposite the side
        names.back()[corner] = parent_.triangle_edges[f][side];
        lengths.back()[corner] = parent_.edge_lengths[parent_.triangle_edges[f][side]];
      }
    }
    return make_intrinsic_surface(static_cast<int>(part.vertex_index.size()), triangles, lengths, names, execution);
  }

  const Surface& parent_;
  PolygonParts parts_;
};

// A loop is longer than another one only by more than this fraction: sums of the same lengths differ by rounding.
constexpr double kLonger = 1e-9;

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
  const std::string boundaries = boundary_count == 1 ? " boundary" : " boundaries";
  return "genus " + std::to_string(genus) + " and " + std::to_string(boundary_count) + boundaries;
}

TopologicalType topological_type(const Surface& surface) {
  const int boundaries = boundary_count(surface);
  // chi = 2 - 2 g - b
  return {(2 - euler_characteristic(surface) - boundaries) / 2, boundaries};
}

BoundaryLoops boundary_loops(const Surface& surface, const HalfEdges& half_edges) {
  BoundaryLoops result;
  result.loop_of_vertex.assign(half_edges.n_vertices(), -1);
  double longest = 0;
  std::size_t first = 0;
  for (int v = 0; v < static_cast<int>(half_edges.n_vertices()); ++v) {
    const HalfedgeHandle start =
        half_edges.halfedge_handle(VertexHandle(v));  // at the boundary, the one without a face
    if (!start.is_valid() || half_edges.face_handle(start).is_valid() || result.loop_of_vertex[v] >= 0) continue;
    std::vector<HalfedgeHandle> loop;
    double length = 0;
    HalfedgeHandle h = start;
    do {
      loop.push_back(h);
      length += surface.edge_lengths[edge_of(h)];
      result.loop_of_vertex[from_vertex(half_edges, h)] = 0;
      h = next(half_edges, h);
    } while (h != start);
    if (length > (1 + kLonger) * longest) longest = length, first = result.loops.size();
    result.loops.push_back(std::move(loop));
  }
  if (first > 0)
    std::rotate(result.loops.begin(), result.loops.begin() + static_cast<std::ptrdiff_t>(first),
                result.loops.begin() + static_cast<std::ptrdiff_t>(first) + 1);
  for (int k = 0; k < result.count(); ++k) {
    for (const HalfedgeHandle h : result.loops[k]) result.loop_of_vertex[from_vertex(half_edges, h)] = k;
  }
  return result;
}

BoundaryLoops renumbered(const BoundaryLoops& boundary, const std::vector<int>& number) {
  BoundaryLoops result;
  result.loops.resize(boundary.loops.size());
  for (int k = 0; k < boundary.count(); ++k) result.loops[number[k]] = boundary.loops[k];
  result.loop_of_vertex = boundary.loop_of_vertex;
  for (int& loop : result.loop_of_vertex) loop = loop < 0 ? -1 : number[loop];
  return result;
}

std::vector<int> boundary_vertices(const HalfEdges& half_edges) {
  std::vector<int> vertices;
  for (int v = 0; v < static_cast<int>(half_edges.n_vertices()); ++v) {
    if (half_edges.is_boundary(VertexHandle(v))) vertices.push_back(v);
  }
  return vertices;
}

std::vector<int> boundary_vertices(const BoundaryLoops& boundary) {
  std::vector<int> vertices;
  for (int v = 0; v < static_cast<int>(boundary.loop_of_vertex.size()); ++v) {
    if (boundary.loop_of_vertex[v] >= 0) vertices.push_back(v);
  }
  return vertices;
}

std::vector<int> triangles_on_one_loop(const Surface& surface, const BoundaryLoops& boundary) {
  std::vector<int> triangles;
  for (int t = 0; t < static_cast<int>(surface.triangles.size()); ++t) {
    const auto [a, b, c] = surface.triangles[t];
    const auto& loop = boundary.loop_of_vertex;
    if (loop[a] >= 0 && loop[a] == loop[b] && loop[a] == loop[c]) triangles.push_back(t);
  }
  return triangles;
}

}  // namespace holomorph::mesh
