#include "tiles/quads.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <tuple>

#include "base/constants.h"

namespace holomorph::tiles {
namespace {

constexpr int kCorners = 4;

// A side between two corners that are kept, with what tells it from another one with the same ends.
struct KeptSide {
  std::array<int, 2> ends, passed;  // vertices in ascending order: its ends, and the first ones from them on
  int face = 0, from = 0, to = 0;   // corners
};

std::array<int, 2> ascending(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

// Polygons by their corners.
class Outlines {
 public:
  Outlines(std::span<const int> offsets, std::span<const int> corner_vertices)
      : offsets_(offsets), vertices_(corner_vertices) {}

  int count() const { return static_cast<int>(offsets_.size()) - 1; }
  int begin(int face) const { return offsets_[face]; }
  int end(int face) const { return offsets_[face + 1]; }
  int after(int face, int corner) const { return corner + 1 < end(face) ? corner + 1 : begin(face); }
  int before(int face, int corner) const { return corner > begin(face) ? corner - 1 : end(face) - 1; }
  int vertex(int corner) const { return vertices_[corner]; }

 private:
  std::span<const int> offsets_, vertices_;
};

// Vertices that are needed besides: all of polygons that would have fewer than three, and those on sides whose ends
// another side has, too.
std::vector<int> missing(const Outlines& outlines, const std::vector<char>& kept) {
  std::vector<int> result;
  std::vector<KeptSide> sides;
  for (int f = 0; f < outlines.count(); ++f) {
    std::vector<int> at;
    for (int c = outlines.begin(f); c < outlines.end(f); ++c) {
      if (kept[outlines.vertex(c)]) at.push_back(c);
    }
    if (at.size() < 3) {
      for (int c = outlines.begin(f); c < outlines.end(f); ++c) {
        if (!kept[outlines.vertex(c)]) result.push_back(outlines.vertex(c));
      }
    }
    for (std::size_t k = 0; k < at.size(); ++k) {
      const int from = at[k], to = at[(k + 1) % at.size()];
      sides.push_back({ascending(outlines.vertex(from), outlines.vertex(to)),
                       ascending(outlines.vertex(outlines.after(f, from)), outlines.vertex(outlines.before(f, to))), f,
                       from, to});
    }
  }
  std::ranges::sort(sides, {}, [](const KeptSide& side) { return std::tie(side.ends, side.passed); });
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    while (end < sides.size() && sides[end].ends == sides[begin].ends) ++end;
    if (sides[begin].passed == sides[end - 1].passed) continue;
    for (std::size_t k = begin; k < end; ++k) {
      const auto& [ends, passed, face, from, to] = sides[k];
      for (int c = outlines.after(face, from); c != to; c = outlines.after(face, c))
        result.push_back(outlines.vertex(c));
    }
  }
  std::erase_if(result, [&](int v) { return kept[v] != 0; });
  return result;
}

int face_count(const Cells& cells) { return static_cast<int>(cells.offsets.size()) - 1; }

// The same cells without polygons.
Cells without_faces(const Cells& cells) {
  Cells result;
  result.vertices = cells.vertices;
  result.is_needed = cells.is_needed;
  return result;
}

// Adds a polygon of these corners of one of the cells.
void add(Cells& result, const Cells& cells, int face, const std::vector<int>& corners) {
  for (const int c : corners) {
    result.corner_vertices.push_back(cells.corner_vertices[c]);
    result.corner_points.push_back(cells.corner_points[c]);
  }
  result.offsets.push_back(static_cast<int>(result.corner_vertices.size()));
  result.tiles.push_back(cells.tiles[face]);
  result.poles.push_back(cells.poles[face]);
  result.is_whole.push_back(cells.is_whole[face]);
  result.turns.push_back(cells.turns[face]);
}

Eigen::Vector3d position(const mesh::Surface& surface, const Locations& points, int point) {
  Eigen::Vector3d result = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    const int v = surface.triangles[points.triangles[point]][i];
    result += points.barycentric[point][i] * Eigen::Vector3d(surface.polygons.vertices[v].data());
  }
  return result;
}

// Radians by which an angle of a quad is off a right one at most.
double worst_angle(const std::array<Eigen::Vector3d, kCorners>& quad) {
  double result = 0;
  for (int i = 0; i < kCorners; ++i) {
    const Eigen::Vector3d a = quad[(i + 1) % kCorners] - quad[i], b = quad[(i + kCorners - 1) % kCorners] - quad[i];
    result = std::max(result, std::abs(std::atan2(a.cross(b).norm(), a.dot(b)) - kTwoPi / 4));
  }
  return result;
}

}  // namespace

std::vector<char> needed_vertices(std::span<const int> offsets, std::span<const int> corner_vertices,
                                  std::vector<char> is_needed) {
  const Outlines outlines(offsets, corner_vertices);
  for (std::vector<int> more; !(more = missing(outlines, is_needed)).empty();) {
    for (const int v : more) is_needed[v] = 1;
  }
  return is_needed;
}

Cells simplified(const Cells& cells) {
  const std::vector<char> kept = needed_vertices(cells.offsets, cells.corner_vertices, cells.is_needed);
  Cells result;
  std::vector<int> number(kept.size(), kNone);
  for (std::size_t v = 0; v < kept.size(); ++v) {
    if (!kept[v]) continue;
    number[v] = static_cast<int>(result.vertices.triangles.size());
    result.vertices.push_back(cells.vertices.triangles[v], cells.vertices.barycentric[v]);
  }
  result.is_needed.assign(result.vertices.triangles.size(), 1);
  for (int f = 0; f < face_count(cells); ++f) {
    std::vector<int> corners;
    for (int c = cells.offsets[f]; c < cells.offsets[f + 1]; ++c) {
      if (kept[cells.corner_vertices[c]]) corners.push_back(c);
    }
    add(result, cells, f, corners);
  }
  for (int& v : result.corner_vertices) v = number[v];
  return result;
}

Cells in_quads(const mesh::Surface& surface, const Cells& cells) {
  Cells result = without_faces(cells);
  std::set<std::array<int, 2>> sides;  // no other edge may join the same vertices
  const Outlines outlines(cells.offsets, cells.corner_vertices);
  for (int f = 0; f < outlines.count(); ++f) {
    for (int c = outlines.begin(f); c < outlines.end(f); ++c)
      sides.insert(ascending(outlines.vertex(c), outlines.vertex(outlines.after(f, c))));
  }
  for (int f = 0; f < outlines.count(); ++f) {
    const int begin = outlines.begin(f), count = outlines.end(f) - begin;
    std::vector<int> own(count);
    std::iota(own.begin(), own.end(), begin);
    std::vector<std::vector<int>> best{own};
    double least = kInfinity;
    for (int start = 0; start < count && count > kCorners && count % 2 == 0; ++start) {
      const auto corner = [&](int k) { return begin + (start + k) % count; };
      std::vector<std::vector<int>> fan;
      double worst = 0;
      for (int k = 1; k + 2 < count; k += 2) {
        fan.push_back({corner(0), corner(k), corner(k + 1), corner(k + 2)});
        std::array<Eigen::Vector3d, kCorners> points;
        for (int i = 0; i < kCorners; ++i)
          points[i] = position(surface, cells.vertices, outlines.vertex(fan.back()[i]));
        worst = std::max(worst, worst_angle(points));
        const bool is_last = k + 3 == count;
        if (!is_last && sides.contains(ascending(outlines.vertex(corner(0)), outlines.vertex(corner(k + 2)))))
          worst = kInfinity;
      }
      if (worst < least) least = worst, best = std::move(fan);
    }
    for (const std::vector<int>& corners : best) {
      add(result, cells, f, corners);
      sides.insert(ascending(outlines.vertex(corners.front()), outlines.vertex(corners.back())));
    }
  }
  return result;
}

}  // namespace holomorph::tiles
