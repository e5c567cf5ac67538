#include "mesh/io/weld.h"

#include <algorithm>
#include <bit>

namespace holomorph::mesh {
namespace {

using Point = std::array<double, 3>;

/// Gives equal points equal numbers, counted by first appearance. NaN equals nothing, so each such point is a vertex of
/// its own.
class Weld {
 public:
  explicit Weld(std::size_t corners) : slots_(std::bit_ceil(2 * corners + 1), empty) {}

  std::int64_t operator()(Point p) {
    for (auto& x : p) x += 0.0;  // -0 becomes 0, so that equal coordinates have equal bits
    const auto mask = slots_.size() - 1;
    for (auto slot = hash(p) & mask;; slot = (slot + 1) & mask) {  // ends: at least half of the slots are empty
      if (slots_[slot] == empty) {
        slots_[slot] = static_cast<std::int64_t>(points.size());
        points.push_back(p);
        return slots_[slot];
      }
      if (points[static_cast<std::size_t>(slots_[slot])] == p) return slots_[slot];
    }
  }

  std::vector<Point> points;

 private:
  static constexpr std::int64_t empty = -1;

  static std::size_t hash(const Point& p) {
    std::uint64_t h = 0;
    for (const auto x : p) {  // multiply and fold, so that the low bits depend on all bits of all coordinates
      h = (h ^ std::bit_cast<std::uint64_t>(x)) * 0x9E3779B97F4A7C15u;
      h ^= h >> 32;
    }
    return static_cast<std::size_t>(h);
  }

  std::vector<std::int64_t> slots_;
};

}  // namespace

GivenPolygons welded(const GivenPolygons& given) {
  const auto exists = [&](std::int64_t v) { return v >= 0 && v < std::ssize(given.vertices); };
  if (!std::all_of(given.corner_vertices.begin(), given.corner_vertices.end(), exists)) return given;
  GivenPolygons mesh;
  Weld weld(given.corner_vertices.size());
  mesh.face_offsets.push_back(0);
  for (std::size_t f = 0; f + 1 < given.face_offsets.size(); ++f) {
    const auto first = mesh.corner_vertices.size();
    std::vector<int>& corners = mesh.file.corner_index;
    for (auto c = given.face_offsets[f]; c < given.face_offsets[f + 1]; ++c) {
      const std::int64_t welded = weld(given.vertices[given.corner_vertices[c]]);
      if (mesh.corner_vertices.size() > first && mesh.corner_vertices.back() == welded) continue;
      mesh.corner_vertices.push_back(welded);
      corners.push_back(static_cast<int>(c));
    }
    while (mesh.corner_vertices.size() > first + 1 && mesh.corner_vertices.back() == mesh.corner_vertices[first])
      mesh.corner_vertices.pop_back();
    const bool collapsed = mesh.corner_vertices.size() - first < 3;
    if (collapsed && given.face_offsets[f + 1] - given.face_offsets[f] >= 3) {
      mesh.corner_vertices.resize(first);
    } else {
      mesh.face_offsets.push_back(static_cast<std::int64_t>(mesh.corner_vertices.size()));
      mesh.file.face_index.push_back(static_cast<int>(f));
    }
    corners.resize(mesh.corner_vertices.size());
  }
  mesh.vertices = std::move(weld.points);
  mesh.file.first_number = given.file.first_number;
  mesh.file.notes = given.file.notes;
  if (mesh.corner_vertices.size() == given.corner_vertices.size()) mesh.file.face_index = mesh.file.corner_index = {};
  return mesh;
}

}  // namespace holomorph::mesh
