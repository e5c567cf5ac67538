#include "islands/island_cuts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "islands/cuts_to_disks.h"
#include "islands/fill_holes.h"
#include "islands/split_overlaps.h"
#include "mesh/border_paths.h"
#include "mesh/cut_open.h"
#include "mesh/hard_edges.h"

namespace holomorph::islands {
namespace {

constexpr double kStretched = 2.5;  // factor of lengths, from which on a piece is also tried with cuts to cone points

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

Cuts::Cuts(const mesh::Surface& surface, std::vector<char> is_hard, Execution& execution)
    : surface_(&surface), sides_(sides_of(surface)), is_cut_(std::move(is_hard)) {
  add(mesh::cuts_to_tips(surface, is_cut_, execution));
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

std::vector<char> Cuts::to_cones(const mesh::Surface& pieces, const Flattening& flat, Execution& execution) const {
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
    if (v >= 0 && stretch[v] > std::log(kStretched)) starts[v] = 1;
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

}  // namespace holomorph::islands
