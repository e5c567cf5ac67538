#include "structure/paper_levels.h"

#include <algorithm>
#include <numeric>
#include <span>

#include "base/errors.h"
#include "mesh/half_edges.h"
#include "mesh/triangle_geometry.h"
#include "progressive/simplify.h"
#include "topology/homology.h"

namespace holomorph::structure {
namespace {

using mesh::HalfedgeHandle;
using mesh::Surface;
using progressive::ProgressiveMesh;

// Classes and loops of a triangulation whose diagonals were flipped for a progressive mesh, on the input triangulation.

// #E the polygon of each diagonal that was flipped, -1 for all other edges.
std::vector<int> flipped_polygons(const Surface& surface, const Surface& flipped) {
  std::vector<int> polygon(surface.edges.size(), -1);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    for (const int e : surface.triangle_edges[t]) {
      if (surface.edges[e] != flipped.edges[e]) polygon[e] = surface.triangle_faces[t];
    }
  }
  return polygon;
}

// The half-edge from a to b. @pre there is one
HalfedgeHandle half_edge(const mesh::HalfEdges& half_edges, int a, int b) {
  HalfedgeHandle h = half_edges.halfedge_handle(mesh::VertexHandle(a));
  while (mesh::to_vertex(half_edges, h) != b) h = mesh::next(half_edges, mesh::opposite(h));
  return h;
}

// Vertices of a polygon from a to b, both included.
std::vector<int> path_along(const Surface& surface, int face, int a, int b) {
  const auto& [vertices, corners, offsets, file] = surface.polygons;
  const auto begin = corners.begin() + offsets[face], end = corners.begin() + offsets[face + 1];
  std::vector<int> path;
  for (auto c = std::find(begin, end, a); path.empty() || path.back() != b; c = c + 1 == end ? begin : c + 1) {
    path.push_back(static_cast<int>(*c));
  }
  return path;
}

// Computes the values of closed forms on the diagonals that were flipped: sums along the polygon from one end to the
// other.
// @param flipped the surface with other diagonals (progressive::with_single_edges), edges numbered alike
// @param forms on the edges of `flipped`; changed to those on the edges of `surface`
void values_of_diagonals(const Surface& surface, const Surface& flipped, topology::IntegerForms& forms) {
  const std::vector<int> polygon = flipped_polygons(surface, flipped);
  // Edges of polygons come first, in lexicographic order.
  const auto polygon_edges = std::span(surface.edges).first(static_cast<std::size_t>(surface.polygon_edge_count));
  for (std::size_t e = 0; e < surface.edges.size(); ++e) {
    if (polygon[e] < 0) continue;
    const auto path = path_along(surface, polygon[e], surface.edges[e][0], surface.edges[e][1]);
    // By closedness: the polygon is a disk, so both ways around give the same sum.
    topology::IntegerForms::Row sum;
    for (std::size_t i = 0; i + 1 < path.size(); ++i) {
      sum = topology::add(sum, forms.rows[mesh::edge_between(polygon_edges, path[i], path[i + 1])],
                          path[i] < path[i + 1] ? 1 : -1);
    }
    forms.rows.set(e, std::move(sum));
  }
}

// Converts closed loops of vertices along the edges of `flipped` to loops of half-edges of `surface`. A step along an
// edge that `surface` does not have becomes a path along the polygon, which is homotopic.
std::vector<std::vector<HalfedgeHandle>> loops_of_half_edges(const Surface& surface, const Surface& flipped,
                                                             const std::vector<std::vector<int>>& loops,
                                                             Execution& execution) {
  const std::vector<int> polygon = flipped_polygons(surface, flipped);
  const mesh::HalfEdges half_edges = mesh::half_edges(flipped, execution);
  std::vector<std::vector<HalfedgeHandle>> result;
  for (const auto& loop : loops) {
    result.emplace_back();
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const int a = loop[i], b = loop[(i + 1) % loop.size()];
      const HalfedgeHandle h = half_edge(half_edges, a, b);
      const int face = polygon[mesh::edge_of(h)];
      const std::vector<int> path = face < 0 ? std::vector<int>{a, b} : path_along(surface, face, a, b);
      for (std::size_t k = 0; k + 1 < path.size(); ++k)
        result.back().push_back(half_edge(half_edges, path[k], path[k + 1]));
    }
  }
  return result;
}

// Least area of a triangle of a level over the sum of its squared sides, which is 0.144 for an equilateral one. All its
// cotangents shrink by one factor, so that the matrix remains positive semi-definite.
constexpr double kLeastLevelArea = 1e-3;
// Part of the time of paper_levels that edge collapses take, for the progress function.
constexpr double kCollapsing = 0.8;

// Cotangents / 2 of a triangle's angles, entry i opposite side i from corner i to the next.
std::array<double, 3> side_weights(const std::array<std::array<double, 3>, 3>& corners) {
  std::array<double, 3> length;
  for (int i = 0; i < 3; ++i) length[i] = mesh::distance(corners[i], corners[(i + 1) % 3]);
  const auto& [a, b, c] = length;
  const double area = std::max(mesh::triangle_area(a, b, c), kLeastLevelArea * (a * a + b * b + c * c));
  if (!(area > 0)) return {0, 0, 0};
  return {mesh::cotangent(a, b, c, area) / 2, mesh::cotangent(b, c, a, area) / 2, mesh::cotangent(c, a, b, area) / 2};
}

void set_base(const topology::BaseBases& base, PaperLevels& levels) {
  levels.base_classes = topology::concatenated(base.classes, base.relative);
  levels.base_loop_of_vertex = base.boundary.loop_of_vertex;
}

// The rows of a level's vertices, and with boundary those in the second copy of its double.
struct Rows {
  std::vector<std::vector<int>> copies;
  int count = 0;
};

Rows rows_of(const PaperLevels& levels, int vertices) {
  Rows result;
  for (int copy = 0; copy < (levels.closed() ? 1 : 2); ++copy) {
    std::vector<int> rows(static_cast<std::size_t>(vertices));
    for (std::size_t v = 0; v < levels.place.size(); ++v) {
      const int p = levels.place[v];
      if (p >= vertices) continue;
      // A boundary vertex belongs to both copies, and has one row.
      const bool is_shared = copy > 0 && levels.on_boundary(static_cast<int>(v));
      rows[p] = is_shared ? result.copies[0][p] : result.count++;
    }
    result.copies.push_back(std::move(rows));
  }
  return result;
}

// The row of the level for each row of the surface. @param to_level as progressive::vertex_map
std::vector<int> row_of_row(const PaperLevels& levels, const std::vector<std::vector<int>>& copies,
                            const std::vector<int>& to_level) {
  std::vector<int> result;
  result.reserve(static_cast<std::size_t>(row_count(levels)));
  for (const auto& rows : copies) {
    for (std::size_t v = 0; v < levels.place.size(); ++v) {
      const bool is_shared = result.size() >= levels.place.size() && levels.on_boundary(static_cast<int>(v));
      if (!is_shared) result.push_back(rows[to_level[levels.place[v]]]);
    }
  }
  return result;
}

// Assembles L and B from the sides of triangles, copy by copy.
class Assembly {
 public:
  Assembly(const PaperLevels& levels, int rows, std::size_t triangles)
      : levels_(levels),
        to_base_(progressive::vertex_map(*levels.mesh, 0)),
        B_(Eigen::MatrixXd::Zero(rows, levels.base_classes.form_count)) {
    entries_.reserve(12 * triangles);
  }

  // A side from a to b with the weight, whose vertices have these rows.
  void add(int a, int b, double weight, int tail, int head, bool is_second) {
    entries_.insert(entries_.end(),
                    {{tail, tail, weight}, {tail, head, -weight}, {head, head, weight}, {head, tail, -weight}});
    // The class on this side is pulled back from M0: 0 if both ends were collapsed into one vertex, else the value on
    // the base edge, whose direction is from the lower to the higher vertex.
    a = to_base_[a], b = to_base_[b];
    if (a == b) return;
    const int edge = mesh::edge_between(levels_.mesh->base.edges, a, b);
    for (const auto& [form, value] : levels_.base_classes.rows[edge]) {
      // Relative classes are extended antisymmetrically to the second copy (§ 8).
      const bool is_negative = is_second && form >= levels_.bases.classes.form_count;
      const double flux = weight * ((a < b) == is_negative ? -value : value);
      B_(head, form) -= flux;
      B_(tail, form) += flux;
    }
  }

  LevelSystem system() {
    const auto n = B_.rows();
    solver::Laplacian::Matrix L(n, n);
    L.setFromTriplets(entries_.begin(), entries_.end());
    return {{{L.outerIndexPtr(), L.outerIndexPtr() + n + 1},
             {L.innerIndexPtr(), L.innerIndexPtr() + L.nonZeros()},
             {L.valuePtr(), L.valuePtr() + L.nonZeros()}},
            std::move(B_),
            {}};
  }

 private:
  const PaperLevels& levels_;
  std::vector<int> to_base_;
  std::vector<Eigen::Triplet<double>> entries_;
  Eigen::MatrixXd B_;
};

}  // namespace

Eigen::Index row_count(const PaperLevels& levels) {
  const auto n = static_cast<Eigen::Index>(levels.place.size());
  if (levels.closed()) return n;
  const auto& loop = levels.bases.boundary.loop_of_vertex;
  return n + std::count(loop.begin(), loop.end(), -1);
}

PaperLevels paper_levels(const mesh::Surface& surface, Execution& execution) {
  if (surface.intrinsic()) {
    throw InvalidMesh(
        "the paper's solver needs positions, and this surface has edge lengths only; "
        "take one of auto, direct, multigrid");
  }
  PaperLevels levels;
  execution.part(0, kCollapsing);
  {
    const Execution::Within within(execution);
    levels.mesh =
        std::make_shared<const ProgressiveMesh>(progressive_mesh(surface, progressive::Order::quadric, execution));
  }
  const ProgressiveMesh& mesh = *levels.mesh;
  levels.splits = static_cast<int>(mesh.splits.size());
  levels.place.resize(mesh.vertex_index.size());
  for (std::size_t p = 0; p < levels.place.size(); ++p) levels.place[mesh.vertex_index[p]] = static_cast<int>(p);
  const auto flipped = progressive::with_single_edges(surface);
  const mesh::Surface& triangulation = flipped ? *flipped : surface;
  levels.triangles.reserve(mesh.triangle_index.size());
  for (const int t : mesh.triangle_index) {
    levels.triangles.push_back(triangulation.triangles[t]);
    for (int& v : levels.triangles.back()) v = levels.place[v];
  }

  // The loops of M0 take the numbers of the surface's loops, so that classes correspond.
  levels.bases.boundary = mesh::boundary_loops(surface, mesh::half_edges(surface, execution));
  std::vector<int> loop_of_vertex;
  for (int p = 0; p < mesh.base_vertex_count(); ++p)
    loop_of_vertex.push_back(levels.bases.boundary.loop_of_vertex[mesh.vertex_index[p]]);
  const topology::BaseBases base = topology::base_bases(mesh.base, loop_of_vertex);
  set_base(base, levels);
  const std::vector<int> to_base = progressive::vertex_map(mesh, 0);
  std::vector<int> map(levels.place.size());
  for (std::size_t v = 0; v < map.size(); ++v) map[v] = to_base[levels.place[v]];
  levels.bases.classes = topology::pull_back_classes(mesh.base, base.classes, triangulation, map);
  auto loops = topology::lift_loops(mesh, levels.splits, base.loops);
  for (auto& loop : loops) {
    for (int& v : loop) v = mesh.vertex_index[v];
  }
  if (flipped) values_of_diagonals(surface, *flipped, levels.bases.classes);
  levels.bases.loops = loops_of_half_edges(surface, triangulation, loops, execution);
  return levels;
}

PaperLevels paper_levels(const ProgressiveMesh& mesh, int splits, const mesh::Surface& level) {
  PaperLevels levels;
  levels.mesh = {std::shared_ptr<void>(), &mesh};
  levels.splits = splits;
  levels.place.resize(static_cast<std::size_t>(level.vertex_count));
  std::iota(levels.place.begin(), levels.place.end(), 0);
  levels.triangles.assign(level.triangles.begin(), level.triangles.end());
  const topology::BaseBases base = topology::base_bases(mesh.base);
  set_base(base, levels);
  levels.bases = topology::lifted_bases(mesh, splits, level, base);
  return levels;
}

LevelSystem level_system(const PaperLevels& levels, int splits) {
  const ProgressiveMesh& mesh = *levels.mesh;
  const auto triangle_count = static_cast<std::size_t>(progressive::triangle_count(mesh, splits));
  const std::vector<int> to_level = progressive::vertex_map(mesh, splits);
  const auto [copies, count] = rows_of(levels, mesh.base_vertex_count() + splits);

  Assembly assembly(levels, count, triangle_count * copies.size());
  for (std::size_t t = 0; t < triangle_count; ++t) {
    mesh::Triple v = levels.triangles[t];
    for (int& corner : v) corner = to_level[corner];
    const auto weights = side_weights({mesh.positions[v[0]], mesh.positions[v[1]], mesh.positions[v[2]]});
    for (std::size_t copy = 0; copy < copies.size(); ++copy) {
      const auto& rows = copies[copy];
      for (int i = 0; i < 3; ++i) {
        const int a = v[i], b = v[(i + 1) % 3];
        assembly.add(a, b, weights[i], rows[a], rows[b], copy > 0);
      }
    }
  }
  LevelSystem system = assembly.system();
  system.row = row_of_row(levels, copies, to_level);
  return system;
}

}  // namespace holomorph::structure
