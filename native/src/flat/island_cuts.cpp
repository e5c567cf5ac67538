#include "flat/island_cuts.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <utility>

#include "base/errors.h"
#include "flat/dirichlet_problem.h"
#include "flat/split_overlaps.h"
#include "mesh/components.h"
#include "mesh/cut_open.h"
#include "mesh/half_edges.h"
#include "mesh/hard_edges.h"
#include "mesh/make_surface.h"
#include "mesh/union_find.h"
#include "uv/evening.h"

namespace holomorph::flat {
namespace {

using Rows = Eigen::Index;

// A map whose scale factors all lie within this part of 1 stretches nothing that could be seen.
constexpr double kUnseen = 1e-3;

bool is_disk(const mesh::Surface& island) {
  const auto type = mesh::topological_type(island);
  return type.genus == 0 && type.boundary_count == 1;
}

// Calls visit(k, island) for each island in turn. Its part of the progress is its share of the triangles.
template <class Visit>
void for_islands(const std::vector<mesh::Component>& islands, Execution& execution, const Visit& visit) {
  double all = 1, done = 0;
  for (const auto& island : islands) all += static_cast<double>(island.surface.triangles.size());
  for (std::size_t k = 0; k < islands.size(); ++k) {
    const double share = static_cast<double>(islands[k].surface.triangles.size()) / all;
    execution.part(done, done + share);
    const Execution::Within within(execution);
    visit(k, islands[k]);
    done += share;
  }
}

// Writes the map of an island, and its scale factors.
void write(const mesh::Component& island, const flat::PlaneMap& map, Flattening& result) {
  const auto& vertices = island.surface.polygons.corner_vertices;
  for (std::size_t c = 0; c < vertices.size(); ++c) {
    const auto z = map.points[vertices[c]];
    result.uv.row(island.corner_index[c]) << z.real(), z.imag();
  }
  for (std::size_t v = 0; v < island.vertex_index.size(); ++v)
    result.scale_factors[island.vertex_index[v]] = map.scale_factors[static_cast<Rows>(v)];
}

uv::UvArray rows_of(const mesh::Component& island, const uv::UvArray& uv) {
  uv::UvArray result(static_cast<Rows>(island.corner_index.size()), 2);
  for (std::size_t c = 0; c < island.corner_index.size(); ++c)
    result.row(static_cast<Rows>(c)) = uv.row(island.corner_index[c]);
  return result;
}

bool stretches(const mesh::Component& island, const std::vector<double>& scale_factors) {
  // Negated, so that a scale factor that is not a number counts as stretch.
  return std::any_of(island.vertex_index.begin(), island.vertex_index.end(),
                     [&](int v) { return !(std::abs(scale_factors[v] - 1) <= kUnseen); });
}

void even(const mesh::Surface& island, double evenness, uv::UvArray& uv, Execution& execution) {
  try {
    const uv::UvArray delta = uv::evened(island, uv, {}, evenness, execution);
    const auto& vertices = island.polygons.corner_vertices;
    for (std::size_t c = 0; c < vertices.size(); ++c) uv.row(static_cast<Rows>(c)) += delta.row(vertices[c]);
  } catch (const SolverError&) {  // the island stays conformal
  }
}

// Small holes filled, so that a piece with holes is flattened as a disk.

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

// Fills small holes with a polygon each, appended at the end. A hole is small if its component has genus 0 and another
// loop of it is more than twice as long. Corners and polygons keep their numbers; diagonals may change.
// @throws Cancelled
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

// Where to cut islands with several boundary loops, or with handles, until they are disks.

// Marks the edge and the paths from its ends.
void mark(const mesh::Surface& surface, const mesh::BorderPaths& paths, int edge, std::vector<char>& is_cut) {
  is_cut[edge] = 1;
  for (const int v : surface.edges[edge]) paths.mark(surface, v, is_cut);
}

// Returns for each edge of a polygon whether it is cut, #E. The cuts are short paths from boundary to boundary, and
// leave disks of the components with a boundary. Disks and closed components are not cut.
//
// A forest of shortest paths to the boundary is grown first. A spanning tree of the faces crosses none of its edges,
// and prefers edges far from the boundary. Both leave 1 - chi edges of each component. These and the paths from their
// ends are the cut (Erickson and Har-Peled 2004, doi:10.1007/s00454-003-2948-z).
// Cost: O(n log n).
std::vector<char> cuts_to_disks(const mesh::Surface& surface, Execution& execution) {
  const mesh::BorderPaths forest = mesh::border_paths(surface, mesh::on_border(surface, {}), {}, execution);
  const auto faces = mesh::edge_faces(surface);
  std::vector<char> is_in_forest(surface.edges.size(), 0), result(surface.edges.size(), 0);
  for (const int e : forest.edge_to_border) {
    if (e >= 0) is_in_forest[e] = 1;
  }
  const auto loop_length = [&](int e) {
    const auto [a, b] = surface.edges[e];
    return forest.distances[a] + forest.distances[b] + surface.edge_lengths[e];
  };
  std::vector<int> crossed;  // edges that the tree of faces may cross
  for (int e = 0; e < surface.polygon_edge_count; ++e) {
    if (faces[e][1] >= 0 && !is_in_forest[e] && std::isfinite(loop_length(e))) crossed.push_back(e);
  }
  // Kruskal's algorithm, the longest loops first. An edge that would close a circle of faces is cut, with the paths
  // from its ends to the border: it has one of the shortest loops.
  std::vector<double> length(surface.polygon_edge_count, 0);
  for (const int e : crossed) length[e] = loop_length(e);
  std::stable_sort(crossed.begin(), crossed.end(), [&](int a, int b) { return length[a] > length[b]; });
  mesh::UnionFind tree(surface.polygons.face_offsets.size());
  for (const int e : crossed) {
    if (tree.lowest(faces[e][0]) != tree.lowest(faces[e][1])) {
      tree.join(faces[e][0], faces[e][1]);
    } else {
      mark(surface, forest, e, result);
    }
  }
  return result;
}

// How far lengths change, as a logarithm, #V.
std::vector<double> stretch_of(const Flattening& flat) {
  std::vector<double> result(flat.scale_factors.size());
  std::ranges::transform(flat.scale_factors, result.begin(), [](double factor) {
    const double stretch = std::abs(std::log(factor));
    return std::isnan(stretch) ? 0 : stretch;
  });
  return result;
}

}  // namespace

Flattening flattened(const mesh::Surface& surface, Execution& execution) {
  const auto islands = mesh::components(surface, execution);
  Flattening result{uv::UvArray::Zero(static_cast<Rows>(surface.polygons.corner_vertices.size()), 2),
                    std::vector<double>(surface.vertex_count, 1.0), std::vector<char>(islands.size(), 0)};
  execution.stage("islands", 0.0, 1.0);
  for_islands(islands, execution, [&](std::size_t k, const mesh::Component& island) {
    if (!is_disk(island.surface)) return;
    try {
      write(island, flat::free_boundary_map(island.surface, {}, execution), result);
      result.is_flat[k] = 1;
    } catch (const SolverError&) {  // is_flat stays 0: the caller is told
    }
  });
  execution.finish();
  return result;
}

uv::UvArray evened(const mesh::Surface& surface, const Flattening& flattening, double evenness, Execution& execution) {
  const auto islands = mesh::components(surface, execution);
  uv::UvArray result = flattening.uv;
  execution.stage("evening", 0.0, 1.0);
  for_islands(islands, execution, [&](std::size_t, const mesh::Component& island) {
    if (!stretches(island, flattening.scale_factors)) return;
    uv::UvArray uv = rows_of(island, flattening.uv);
    if (evenness > 0) even(island.surface, evenness, uv, execution);
    // An island that is stretched gets the area in the plane that it has on the surface. Without an area in the plane
    // it stays as it was flattened.
    const double scale = std::sqrt(mesh::area(island.surface, execution.workers()) /
                                   uv::frame(island.surface, uv, 0.0, execution.workers()).area);
    if (!std::isfinite(scale)) return;
    for (std::size_t c = 0; c < island.corner_index.size(); ++c)
      result.row(island.corner_index[c]) = scale * uv.row(static_cast<Rows>(c));
  });
  execution.finish();
  return result;
}

Sides sides_of(const mesh::Surface& surface) {
  const std::size_t count = surface.polygons.corner_vertices.size();
  Sides result{std::vector<int>(count, 0), std::vector<int>(count, 0)};
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const int edge = surface.triangle_edges[t][i];
      if (surface.is_diagonal(edge)) continue;
      const int corner = surface.triangle_corners[t][i];
      result.edge[corner] = edge;
      result.following[corner] = surface.triangle_corners[t][(i + 1) % 3];
    }
  }
  return result;
}

Cuts::Cuts(const mesh::Surface& surface, std::vector<char> is_hard, bool to_tips, Execution& execution)
    : surface_(&surface), sides_(sides_of(surface)), is_cut_(std::move(is_hard)) {
  if (to_tips) add(mesh::cuts_to_tips(surface, is_cut_, execution));
  const mesh::Surface open = pieces(execution);
  execution.stage("cuts", 0, 1);
  add(of_pieces(open, cuts_to_disks(open, execution)));
}

mesh::Surface Cuts::pieces(Execution& execution) const {
  return filled(mesh::cut_open(*surface_, is_cut_, execution).surface, execution);
}

bool Cuts::add(const std::vector<char>& cuts) {
  bool has_any = false;
  for (std::size_t e = 0; e < cuts.size(); ++e) {
    if (cuts[e]) is_cut_[e] = 1, has_any = true;
  }
  return has_any;
}

std::vector<char> Cuts::to_cones(const mesh::Surface& pieces, const Flattening& flat, double most_stretch,
                                 Execution& execution) const {
  const std::vector<double> stretch = stretch_of(flat);
  std::vector<int> worst(pieces.component_count, -1);  // vertices; of equals the lowest
  for (std::size_t t = 0; t < pieces.triangles.size(); ++t) {
    int& own = worst[pieces.face_component[pieces.triangle_faces[t]]];
    for (const int v : pieces.triangles[t]) {
      if (own < 0 || stretch[v] > stretch[own] || (stretch[v] == stretch[own] && v < own)) own = v;
    }
  }
  std::vector<char> starts(pieces.vertex_count, 0);
  for (const int v : worst) {
    if (v >= 0 && stretch[v] > std::log(most_stretch)) starts[v] = 1;
  }
  return of_pieces(pieces, mesh::paths_to_border(pieces, mesh::on_border(pieces, {}), starts, execution));
}

std::vector<char> Cuts::across_overlaps(const mesh::Surface& pieces, const uv::UvArray& uv,
                                        Execution& execution) const {
  execution.stage("overlaps", 0, 1);
  return of_pieces(pieces, mesh::edges_between(pieces, parted(pieces, uv, execution)));
}

// The edges of the surface that are these of its pieces, #E.
std::vector<char> Cuts::of_pieces(const mesh::Surface& pieces, const std::vector<char>& cuts) const {
  const Sides own = sides_of(pieces);
  std::vector<char> result(is_cut_.size(), 0);
  for (std::size_t c = 0; c < sides_.edge.size(); ++c) {
    if (cuts[own.edge[c]]) result[sides_.edge[c]] = 1;
  }
  return result;
}

std::vector<Joint> Cuts::joints() const {
  std::vector<int> first(is_cut_.size(), -1);
  std::vector<Joint> of_edge(is_cut_.size());
  std::vector<char> is_joint(is_cut_.size(), 0);
  for (int c = 0; c < std::ssize(sides_.edge); ++c) {
    const int edge = sides_.edge[c], one = std::exchange(first[edge], c);
    if (one < 0 || !is_cut_[edge]) continue;
    of_edge[edge] = {one, sides_.following[one], c, sides_.following[c]};
    is_joint[edge] = 1;
  }
  std::vector<Joint> result;
  for (std::size_t e = 0; e < is_joint.size(); ++e) {
    if (is_joint[e]) result.push_back(of_edge[e]);
  }
  return result;
}

}  // namespace holomorph::flat
