#include "tiling/cones/lattice_map.h"

#include <cmath>
#include <utility>

namespace holomorph::tiling {
namespace {

constexpr int kSingleMantissa = 23;  // of single precision, less the sign

int next_of(int side) { return side % 3 == 2 ? side - 2 : side + 1; }

// The symmetry that leads from the frame of the triangle of a side to that of the triangle of the side that runs back.
Symmetry across(const mesh::Surface& surface, const TurnLattice& lattice, const LatticeMap& map, int side, int back) {
  Symmetry own = map.at[side];
  // Seen from the vertex that the side leaves, clockwise.
  const auto cone = map.cones.find(surface.triangles[side / 3][side % 3]);
  if (cone != map.cones.end() && cone->second.side == side) own = after(lattice, own, cone->second.closing);
  return after(lattice, map.at[next_of(back)], inverse(lattice, own));
}

// The two sides of each edge, -1 for none: the one that leaves its lower vertex first.
std::vector<std::array<int, 2>> sides_of_edges(const mesh::Surface& surface) {
  std::vector<std::array<int, 2>> result(surface.edges.size(), {-1, -1});
  for (int t = 0; t < std::ssize(surface.triangles); ++t) {
    for (int i = 0; i < 3; ++i) {
      const int edge = surface.triangle_edges[t][i];
      result[edge][surface.triangles[t][i] == surface.edges[edge][0] ? 0 : 1] = 3 * t + i;
    }
  }
  return result;
}

}  // namespace

Symmetry after(const TurnLattice& lattice, const Symmetry& a, const Symmetry& b) {
  const Turn& turn = lattice.power(a.turn);
  return {(a.turn + b.turn) % lattice.k,
          {turn(0, 0) * b.translation[0] + turn(0, 1) * b.translation[1] + a.translation[0],
           turn(1, 0) * b.translation[0] + turn(1, 1) * b.translation[1] + a.translation[1]}};
}

Symmetry inverse(const TurnLattice& lattice, const Symmetry& a) {
  const int turn = (lattice.k - a.turn) % lattice.k;
  const Symmetry moved = after(lattice, {turn, {}}, {0, a.translation});
  return {turn, {-moved.translation[0], -moved.translation[1]}};
}

uv::UvArray corner_uv(const mesh::Surface& surface, const TurnLattice& lattice, const LatticeMap& map) {
  const double height = lattice.second.imag(), slant = lattice.second.real();
  uv::UvArray uv = uv::UvArray::Zero(static_cast<Eigen::Index>(surface.polygons.corner_vertices.size()), 2);
  std::vector<char> is_cone(map.y.size(), 0);  // at halves and thirds, wherever the grid is
  for (const auto& [v, cone] : map.cones) is_cone[v] = 1;
  const auto write = [&](double grid) {
    for (int side = 0; side < std::ssize(map.at); ++side) {
      const int v = surface.triangles[side / 3][side % 3];
      Eigen::Vector2d own(map.y[v].real() - map.y[v].imag() * slant / height, map.y[v].imag() / height);
      if (grid > 0 && !is_cone[v]) own = (own / grid).array().round() * grid;
      const auto& [turn, by] = map.at[side];
      const Eigen::Vector2d x = lattice.power(turn).cast<double>() * own + Eigen::Vector2d(by[0], by[1]);
      uv.row(surface.triangle_corners[side / 3][side % 3]) = x.transpose();
    }
  };
  write(0);
  const double most = uv.cwiseAbs().maxCoeff();
  write(std::exp2(std::ceil(std::log2(std::max(most, 1.0))) - kSingleMantissa));
  if (lattice.k == 6) {  // the square lattice is the plane's own
    uv.col(0) += slant * uv.col(1);
    uv.col(1) *= height;
  }
  return uv;
}

void join_polygons(const mesh::Surface& surface, const TurnLattice& lattice, LatticeMap& map) {
  if (surface.polygons.face_offsets.size() == surface.triangles.size() + 1) return;
  const std::vector<std::array<int, 2>> sides = sides_of_edges(surface);
  std::vector<char> is_joined(surface.triangles.size(), 0);
  std::vector<int> queue;
  for (int first = 0; first < std::ssize(surface.triangles); ++first) {
    if (std::exchange(is_joined[first], 1)) continue;
    queue.assign(1, first);
    for (std::size_t i = 0; i < queue.size(); ++i) {
      for (int side = 3 * queue[i]; side < 3 * queue[i] + 3; ++side) {
        const auto [up, down] = sides[surface.triangle_edges[queue[i]][side % 3]];
        const int back = side == up ? down : up, t = back / 3;
        if (back < 0 || surface.triangle_faces[t] != surface.triangle_faces[queue[i]]) continue;
        if (std::exchange(is_joined[t], 1)) continue;
        const Symmetry by = across(surface, lattice, map, back, side);
        for (int own = 3 * t; own < 3 * t + 3; ++own) map.at[own] = after(lattice, by, map.at[own]);
        queue.push_back(t);
      }
    }
  }
}

void turn_triangles(const TurnLattice& lattice, const std::vector<int>& by, LatticeMap& map) {
  for (std::size_t side = 0; side < map.at.size(); ++side)
    map.at[side] = after(lattice, {by[side / 3], {}}, map.at[side]);
}

std::vector<Jump> jumps_of(const mesh::Surface& surface, const TurnLattice& lattice, const LatticeMap& map) {
  const std::vector<std::array<int, 2>> sides = sides_of_edges(surface);
  std::vector<Jump> jumps;
  for (int e = 0; e < std::ssize(sides); ++e) {
    const auto [left, right] = sides[e];
    if (left < 0 || right < 0 || surface.triangle_faces[left / 3] == surface.triangle_faces[right / 3]) continue;
    const auto [turn, by] = across(surface, lattice, map, left, right);
    if (turn != 0 || by[0] != 0 || by[1] != 0) jumps.push_back({e, turn, {by[0], by[1]}});
  }
  return jumps;
}

}  // namespace holomorph::tiling
