#include "progressive/corner_values.h"

#include <algorithm>
#include <numeric>
#include <string>

#include "base/errors.h"
#include "mesh/corner_turns.h"
#include "mesh/make_surface.h"
#include "progressive/refinement.h"

namespace holomorph::progressive {
namespace {

// How one map turns from corner to corner. At each vertex there is a frame, that of its first corner.
class MapTurns {
 public:
  /// @param values 2 x #corners. @pre the surface is made of triangles
  MapTurns(const mesh::Surface& surface, const Eigen::Matrix2Xd& values, int k)
      : group_(mesh::TurnGroup::of_plane(k)), frame_(surface.vertex_count, 0) {
    turns_ = mesh::CornerTurns(surface, values.transpose(), group_);
  }

  int at_corner(int corner) const { return turns_.at_corner(corner); }
  bool is_cone(int v) const { return turns_.around(v) != 0; }
  /// From the frame of the vertex that v was collapsed into to that of v.
  int& frame(int v) { return frame_[v]; }
  int frame(int v) const { return frame_[v]; }
  Eigen::Vector2d turned(int r, double x, double y) const { return group_.power(r) * Eigen::Vector2d(x, y); }

 private:
  mesh::TurnGroup group_;
  mesh::CornerTurns turns_;
  std::vector<int> frame_;
};

// Corner i of triangle t is 3t + i, in the numbering of the progressive mesh.
class Wedges {
 public:
  Wedges(const ProgressiveMesh& mesh, const std::vector<double>& values, int width, const std::vector<int>& turns)
      : values_(values), width_(static_cast<std::size_t>(width)), original_(original_corners(mesh)) {
    const int splits = static_cast<int>(mesh.splits.size());
    Refinement refinement(mesh, splits);
    while (refinement.splits_made() < splits) refinement.split();
    const std::vector<Triple> triangles = refinement.triangles();
    find_turns(mesh, turns);
    group(triangles, mesh.vertex_count());
    vertex_parent_.resize(static_cast<std::size_t>(mesh.vertex_count()));
    std::iota(vertex_parent_.begin(), vertex_parent_.end(), 0);
    offset_.assign(vertex_parent_.size() * width_, 0.0);
  }

  // Undoes the split of v_s and `v_t`. `left`, `right`: the corners of v_s and v_t in the two triangles; -1: none.
  void collapse(int v_s, int v_t, std::array<int, 2> left, std::array<int, 2> right) {
    const int main_s = root(left[0] >= 0 ? left[0] : right[0]), main_t = root(left[0] >= 0 ? left[1] : right[1]);
    std::vector<double>& move = scratch_;
    move.resize(width_);
    // The vector from v_t to v_s, in the wedges at one of the two triangles. All wedges of v_t are translated by it.
    settle(vertex_[main_s]);
    settle(vertex_[main_t]);
    for (std::size_t k = 0; k < width_; ++k) move[k] = value(main_s, k) - value(main_t, k);
    // In the frame of v_t. The frame of v_s is turned against it as both are against that triangle.
    for (auto& [column, map] : maps_) {
      if (map.is_cone(v_t)) throw TopologyError("a cone of a map that turns was collapsed: keep all of them");
      const int turn_t = turn(map, main_t);
      turn_by(map, -turn_t, move.data() + column);
      map.frame(v_t) = turn(map, main_s) - turn_t;
    }
    if (left[0] >= 0 && right[0] >= 0) {
      // Where the edge lies on a cut, its sides have different wedges, and each joins the one of v_s on its own side.
      const int other_s = root(right[0]), other_t = root(right[1]);
      if (other_t != main_t) parent_[other_t] = other_s;
    }
    parent_[main_t] = main_s;
    vertex_parent_[v_t] = v_s;
    std::copy(move.begin(), move.end(), offset_.begin() + at(v_t, 0));
  }

  CornerValues level(std::size_t triangle_count) {
    CornerValues result;
    result.values.reserve(3 * triangle_count * width_);
    result.corners.reserve(3 * triangle_count);
    for (int corner = 0; corner < static_cast<int>(3 * triangle_count); ++corner) {
      const int wedge = root(corner);
      settle(vertex_[wedge]);
      for (std::size_t k = 0; k < width_; ++k) result.values.push_back(value(wedge, k));
      result.corners.push_back(original_corner(wedge));
    }
    return result;
  }

 private:
  int original_corner(int corner) const { return original_[corner / 3][corner % 3]; }
  std::ptrdiff_t at(int row, std::size_t k) const { return static_cast<std::ptrdiff_t>(row * width_ + k); }
  const double* row(int corner) const { return values_.data() + at(original_corner(corner), 0); }

  void find_turns(const ProgressiveMesh& mesh, const std::vector<int>& turns) {
    if (std::all_of(turns.begin(), turns.end(), [](int k) { return k == 1; })) return;
    Execution execution;
    const mesh::Surface surface =
        mesh::make_surface(progressive::level(mesh, static_cast<int>(mesh.splits.size())), execution);
    Eigen::Matrix2Xd uv(2, 3 * std::ssize(surface.triangles));
    for (std::size_t m = 0; m < turns.size(); ++m) {
      if (turns[m] == 1) continue;
      for (int c = 0; c < uv.cols(); ++c) uv.col(c) << row(c)[2 * m], row(c)[2 * m + 1];
      maps_.emplace_back(2 * m, MapTurns(surface, uv, turns[m]));
    }
  }

  // From the frame of the vertex of a wedge, in the level, to the wedge. @pre the vertex of its corner is settled
  int turn(const MapTurns& map, int wedge) const { return map.at_corner(wedge) + map.frame(vertex_[wedge]); }
  static void turn_by(const MapTurns& map, int r, double* vector) {
    const Eigen::Vector2d turned = map.turned(r, vector[0], vector[1]);
    std::copy(turned.begin(), turned.end(), vector);
  }

  // Every corner points to the first one of its wedge.
  void group(const std::vector<Triple>& triangles, int vertex_count) {
    const int count = static_cast<int>(3 * triangles.size());
    parent_.resize(static_cast<std::size_t>(count));
    vertex_.resize(parent_.size());
    std::vector<int> begin(static_cast<std::size_t>(vertex_count) + 1, 0), corners(parent_.size());
    for (int c = 0; c < count; ++c) ++begin[1 + (vertex_[c] = triangles[c / 3][c % 3])];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    for (int c = count - 1; c >= 0; --c) corners[--begin[1 + vertex_[c]]] = c;
    const auto less = [this](int a, int b) {
      const int order = compare(a, b);
      return order != 0 ? order < 0 : a < b;
    };
    for (std::size_t first = 0, last; first < corners.size(); first = last) {
      for (last = first; last < corners.size() && vertex_[corners[last]] == vertex_[corners[first]]; ++last) {
      }
      std::sort(corners.begin() + static_cast<std::ptrdiff_t>(first),
                corners.begin() + static_cast<std::ptrdiff_t>(last), less);
      for (std::size_t i = first, wedge = first; i < last; ++i) {
        if (compare(corners[i], corners[wedge]) != 0) wedge = i;
        parent_[corners[i]] = corners[wedge];
      }
    }
  }

  int compare(int a, int b) const {
    const double *x = row(a), *y = row(b);
    for (std::size_t k = 0; k < width_; ++k) {
      if (x[k] != y[k]) return x[k] < y[k] ? -1 : 1;
    }
    // At a centre of turns corners have the same values, and turn apart.
    for (const auto& [column, map] : maps_) {
      if (map.at_corner(a) != map.at_corner(b)) return map.at_corner(a) - map.at_corner(b);
    }
    return 0;
  }

  int root(int corner) {
    while (parent_[corner] != corner) corner = parent_[corner] = parent_[parent_[corner]];
    return corner;
  }

  // Shortens the path of `v` to one step: its parent becomes the vertex that it was collapsed into, its offset the sum
  // along the path.
  void settle(int v) {
    path_.clear();
    while (vertex_parent_[v] != v) {
      path_.push_back(v);
      v = vertex_parent_[v];
    }
    for (std::size_t i = path_.size() - (path_.empty() ? 0 : 1); i-- > 0;) {
      const int u = path_[i], up = path_[i + 1];
      scratch_.assign(offset_.begin() + at(up, 0), offset_.begin() + at(up, 0) + static_cast<std::ptrdiff_t>(width_));
      for (auto& [column, map] : maps_) {
        turn_by(map, map.frame(u), scratch_.data() + column);
        map.frame(u) += map.frame(up);
      }
      for (std::size_t k = 0; k < width_; ++k) offset_[at(u, k)] += scratch_[k];
      vertex_parent_[u] = v;
    }
  }

  // @pre the wedge's vertex is settled
  double value(int wedge, std::size_t k) const {
    const double* offset = offset_.data() + at(vertex_[wedge], 0);
    for (const auto& [column, map] : maps_) {
      if (k / 2 == column / 2)
        return row(wedge)[k] + map.turned(map.at_corner(wedge), offset[column], offset[column + 1])[k % 2];
    }
    return row(wedge)[k] + offset[k];
  }

  const std::vector<double>& values_;
  std::size_t width_;
  std::vector<Triple> original_;
  std::vector<int> parent_;         // union-find of corners: those of one wedge have the same root
  std::vector<int> vertex_;         // vertex of each corner, in the finest level
  std::vector<int> vertex_parent_;  // vertex that each was collapsed into, itself if it is not collapsed
  std::vector<double> offset_;      // #V x width translation on the way to the parent
  std::vector<std::pair<std::size_t, MapTurns>> maps_;  // those that turn, and their first columns
  std::vector<int> path_;
  std::vector<double> scratch_;
};

}  // namespace

std::vector<CornerValues> collapsed_corner_values(const ProgressiveMesh& mesh, const std::vector<double>& values,
                                                  int width, const std::vector<int>& splits,
                                                  const std::vector<int>& turns) {
  // Levels from fine to coarse: each split is undone once for all of them.
  std::vector<std::size_t> fine_to_coarse(splits.size());
  std::iota(fine_to_coarse.begin(), fine_to_coarse.end(), std::size_t{0});
  std::stable_sort(fine_to_coarse.begin(), fine_to_coarse.end(),
                   [&](std::size_t a, std::size_t b) { return splits[a] > splits[b]; });
  std::vector<CornerValues> levels(splits.size());
  Wedges wedges(mesh, values, width, turns);
  int made = static_cast<int>(mesh.splits.size()), triangles = mesh.triangle_count();
  for (const std::size_t i : fine_to_coarse) {
    while (made > splits[i]) {
      const Split& split = mesh.splits[--made];
      std::array<int, 2> left{-1, -1}, right{-1, -1};
      if (split.v_r >= 0) {  // the right triangle is numbered after the left one
        --triangles;
        right = {3 * triangles + (split.slot_r + 1) % 3, 3 * triangles + split.slot_r};
      }
      if (split.v_l >= 0) {
        --triangles;
        left = {3 * triangles + split.slot_l, 3 * triangles + (split.slot_l + 1) % 3};
      }
      wedges.collapse(split.v_s, mesh.base_vertex_count() + made, left, right);
    }
    levels[i] = wedges.level(static_cast<std::size_t>(triangles));
  }
  return levels;
}

}  // namespace holomorph::progressive
