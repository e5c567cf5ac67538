#include "turns/mirrored.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/errors.h"
#include "mesh/make_surface.h"

namespace holomorph::turns {
namespace {

constexpr std::array<Complex, 4> kQuarters{Complex(1, 0), Complex(0, 1), Complex(-1, 0), Complex(0, -1)};

mesh::Mirror mirror_of(const mesh::Surface& surface, uv::Up up) {
  auto found = mesh::mirror(surface, static_cast<int>(up));
  if (!found) throw TopologyError("lines is \"mirror\", and this surface does not mirror itself in a vertical plane");
  return *std::move(found);
}

Complex at(const uv::UvArray& uv, int corner) { return {uv(corner, 0), uv(corner, 1)}; }

}  // namespace

Half::Half(const mesh::Surface& whole, uv::Up up, Execution& execution) : whole_(whole), mirror_(mirror_of(whole, up)) {
  mesh::PolygonParts parts(whole.polygons);
  std::vector<int> faces;
  for (int f = 0; f < std::ssize(mirror_.half); ++f) {
    if (mirror_.half[f]) faces.push_back(f);
  }
  mesh::PolygonPart part = parts.take(std::move(faces));
  corners_ = std::move(part.corner_index);
  vertices_ = std::move(part.vertex_index);
  auto made = std::make_shared<mesh::Surface>(mesh::make_surface(std::move(part.polygons), execution));
  if (made->component_count > 1) throw TopologyError("lines is \"mirror\", and half of this surface falls apart");
  for (int e = 0; e < std::ssize(made->edges); ++e) {
    const auto [a, b] = made->edges[e];
    if (mirror_.on_plane[vertices_[a]] && mirror_.on_plane[vertices_[b]]) lines_.push_back(e);
  }
  surface_ = std::move(made);
}

TurnedMap Half::unfolded(const TurnedMap& of_half, int turns) const {
  TurnedMap result;
  result.uv = unfolded(of_half.uv);
  result.before = unfolded(of_half.before);
  for (const int cone : of_half.cones) result.cones.push_back(vertices_[cone]);
  for (std::size_t k = 0; k < of_half.cones.size(); ++k) result.cones.push_back(mirror_.vertices[result.cones[k]]);
  result.missing = of_half.missing;
  result.missing.insert(result.missing.end(), of_half.missing.begin(), of_half.missing.end());
  add_cones_in_plane(turns, result);
  result.jumps = jumps_of(whole_, result.uv, turns);
  return result;
}

uv::UvArray Half::unfolded(const uv::UvArray& uv) const {
  uv::UvArray result(static_cast<Eigen::Index>(mirror_.corners.size()), 2);
  for (std::size_t c = 0; c < corners_.size(); ++c) {
    const auto own = uv.row(static_cast<Eigen::Index>(c));
    result.row(corners_[c]) = own;
    result.row(mirror_.corners[corners_[c]]) << -own[0], own[1];
  }
  return result;
}

void Half::add_cones_in_plane(int turns, TurnedMap& map) const {
  std::vector<double> around(whole_.vertex_count, 0.0);  // in full turns
  std::vector<char> is_inner(whole_.vertex_count, 1);
  for (std::size_t t = 0; t < whole_.triangles.size(); ++t) {
    std::array<Complex, 3> z;
    for (int i = 0; i < 3; ++i) z[i] = at(map.uv, whole_.triangle_corners[t][i]);
    for (int i = 0; i < 3; ++i) {
      const double angle = std::arg((z[(i + 2) % 3] - z[i]) * std::conj(z[(i + 1) % 3] - z[i]));
      around[whole_.triangles[t][i]] += angle / (2 * std::numbers::pi);
    }
  }
  for (std::size_t e = 0; e < whole_.edges.size(); ++e) {
    if (whole_.edge_face_count[e] == 1) is_inner[whole_.edges[e][0]] = is_inner[whole_.edges[e][1]] = 0;
  }
  for (int v = 0; v < whole_.vertex_count; ++v) {
    const int lacking = static_cast<int>(std::nearbyint((1 - around[v]) * turns));
    if (!mirror_.on_plane[v] || !is_inner[v] || lacking == 0) continue;
    map.cones.push_back(v);
    map.missing.push_back(lacking);
  }
}

std::vector<Jump> jumps_of(const mesh::Surface& surface, const uv::UvArray& uv, int turns) {
  // The UVs at the lower and the higher end of an edge, in the triangle on its left and in that on its right: the left
  // one runs along it, from the lower vertex on.
  struct Sides {
    std::array<Complex, 2> low, high;
    std::array<bool, 2> is_there{};
  };
  std::vector<Sides> sides(surface.edges.size());
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const int next = (i + 1) % 3;
      const bool is_left = surface.triangles[t][i] < surface.triangles[t][next];
      const Complex start = at(uv, surface.triangle_corners[t][i]), end = at(uv, surface.triangle_corners[t][next]);
      Sides& own = sides[surface.triangle_edges[t][i]];
      own.low[is_left ? 0 : 1] = is_left ? start : end;
      own.high[is_left ? 0 : 1] = is_left ? end : start;
      own.is_there[is_left ? 0 : 1] = true;
    }
  }
  std::vector<Jump> result;
  for (int e = 0; e < std::ssize(sides); ++e) {
    const auto& [low, high, is_there] = sides[e];
    if (!is_there[0] || !is_there[1]) continue;
    const double angle = std::arg((high[1] - low[1]) * std::conj(high[0] - low[0]));
    const int turn = static_cast<int>(std::nearbyint(angle * turns / (2 * std::numbers::pi)));
    Jump jump{e, (turn % turns + turns) % turns, {}};
    const Complex by = low[1] - kQuarters[jump.turn * 4 / turns] * low[0];
    jump.translation = {std::llrint(by.real()), std::llrint(by.imag())};
    if (jump.turn != 0 || jump.translation[0] != 0 || jump.translation[1] != 0) result.push_back(jump);
  }
  return result;
}

}  // namespace holomorph::turns
