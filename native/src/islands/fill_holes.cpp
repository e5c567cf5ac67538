#include "islands/fill_holes.h"

#include <algorithm>
#include <cstdint>
#include <set>
#include <vector>

#include "mesh/components.h"
#include "mesh/half_edges.h"
#include "mesh/make_surface.h"

namespace holomorph::islands {
namespace {

constexpr double kSmall = 0.5;  // a hole's length over that of the longest loop

struct Loop {
  std::vector<int> vertices;  // around the hole, which lies on the left
  double length = 0;
};

std::vector<Loop> loops_of(const mesh::Surface& surface, Execution& execution) {
  const auto half_edges = mesh::half_edges(surface, execution);
  std::vector<Loop> loops;
  for (const auto& found : mesh::boundary_loops(surface, half_edges).loops) {
    Loop loop;
    for (const auto h : found) {
      loop.vertices.push_back(mesh::from_vertex(half_edges, h));
      loop.length += surface.edge_lengths[mesh::edge_of(h)];
    }
    loops.push_back(std::move(loop));
  }
  return loops;
}

// A hole that meets a vertex twice cannot be one polygon.
bool is_polygon(const Loop& loop) {
  return loop.vertices.size() >= 3 &&
         std::set<int>(loop.vertices.begin(), loop.vertices.end()).size() == loop.vertices.size();
}

// The holes of one component, as polygons of the vertices of the whole.
std::vector<std::vector<int>> small_holes(const mesh::Component& part, Execution& execution) {
  std::vector<std::vector<int>> holes;
  const auto type = mesh::topological_type(part.surface);
  if (type.genus > 0 || type.boundary_count < 2) return holes;
  auto loops = loops_of(part.surface, execution);
  // Loop 0 is the longest: the outer border, which is never filled.
  const double longest = loops[0].length;
  for (std::size_t k = 1; k < loops.size(); ++k) {
    if (!(loops[k].length < kSmall * longest) || !is_polygon(loops[k])) continue;
    for (int& v : loops[k].vertices) v = part.vertex_index[v];
    holes.push_back(std::move(loops[k].vertices));
  }
  return holes;
}

}  // namespace

mesh::Surface filled(const mesh::Surface& surface, Execution& execution) {
  mesh::Polygons polygons = surface.polygons;
  for (const auto& part : mesh::components(surface, execution)) {
    for (const auto& hole : small_holes(part, execution)) {
      polygons.corner_vertices.insert(polygons.corner_vertices.end(), hole.begin(), hole.end());
      polygons.face_offsets.push_back(static_cast<int>(polygons.corner_vertices.size()));
    }
  }
  if (polygons.face_offsets.size() == surface.polygons.face_offsets.size()) return surface;
  return mesh::make_surface(std::move(polygons), execution);
}

}  // namespace holomorph::islands
