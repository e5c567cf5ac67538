#include "mesh/corner_turns.h"

#include <cassert>
#include <cmath>

namespace holomorph::mesh {
namespace {

constexpr int kNone = -1;

int side_after(int side) { return side % 3 == 2 ? side - 2 : side + 1; }
int before(int side) { return side % 3 == 0 ? side + 2 : side - 1; }

std::vector<int> twins(const Surface& surface) {
  std::vector<int> first(surface.edges.size(), kNone), result(3 * surface.triangles.size(), kNone);
  for (int s = 0; s < std::ssize(result); ++s) {
    int& other = first[surface.triangle_edges[s / 3][s % 3]];
    if (other != kNone) {
      result[s] = other;
      result[other] = s;
    }
    other = s;
  }
  return result;
}

}  // namespace

TurnGroup::TurnGroup(int k, const Eigen::Matrix2d& turn) {
  powers_.push_back(Eigen::Matrix2d::Identity());
  while (order() < k) powers_.push_back(turn * powers_.back());
}

TurnGroup TurnGroup::of_lattice(int k) {
  Eigen::Matrix2d turn = Eigen::Matrix2d::Identity();
  if (k == 2) turn *= -1;
  if (k == 4) turn << 0, -1, 1, 0;
  if (k == 6) turn << 0, -1, 1, 1;
  return {k, turn};
}

TurnGroup TurnGroup::of_plane(int k) {
  if (k != 6) return of_lattice(k);
  Eigen::Matrix2d turn;
  turn << 0.5, -std::sqrt(0.75), std::sqrt(0.75), 0.5;
  return {k, turn};
}

CornerTurns::CornerTurns(const Surface& surface,
                         const Eigen::Ref<const Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>>& values,
                         const TurnGroup& group) {
  if (group.order() == 1) return;
  const std::vector<int> twin = twins(surface);
  const auto along = [&](int side) {
    const Triple& corners = surface.triangle_corners[side / 3];
    return Eigen::Vector2d(values.row(corners[side_after(side) % 3]) - values.row(corners[side % 3]));
  };
  across_.assign(twin.size(), 0);
  for (int s = 0; s < std::ssize(twin); ++s) {
    if (twin[s] <= s) continue;
    const Eigen::Vector2d here = along(s), there = -along(twin[s]);
    int best = 0;
    for (int r = 1; r < group.order(); ++r) {
      const auto off = [&](int turn) { return (group.power(turn) * here - there).squaredNorm(); };
      if (off(r) < off(best)) best = r;
    }
    across_[s] = static_cast<signed char>(best);
    across_[twin[s]] = static_cast<signed char>(group.reduced(-best));
  }
  corner_.assign(twin.size(), kNone);
  around_.assign(surface.vertex_count, 0);
  // Around each vertex counter-clockwise from its first corner, and clockwise where that ends on the boundary.
  for (int start = 0; start < std::ssize(twin); ++start) {
    if (corner_[start] != kNone) continue;
    int turn = 0, at = start;
    do {
      corner_[at] = static_cast<signed char>(group.reduced(turn));
      turn += across_[before(at)];
      at = twin[before(at)];
    } while (at != kNone && at != start);
    if (at == start) around_[surface.triangles[start / 3][start % 3]] = static_cast<signed char>(group.reduced(turn));
    for (at = start, turn = 0; at != kNone && (at == start || corner_[at] == kNone);) {
      corner_[at] = static_cast<signed char>(group.reduced(turn));
      turn += across_[at];
      at = twin[at] == kNone ? kNone : side_after(twin[at]);
    }
  }
}

}  // namespace holomorph::mesh
