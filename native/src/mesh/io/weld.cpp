#include "mesh/io/weld.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include "mesh/welding.h"

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
  GivenPolygons mesh = given;
  Weld weld(mesh.corner_vertices.size());
  for (std::int64_t& v : mesh.corner_vertices) v = weld(given.vertices[v]);
  mesh.vertices = std::move(weld.points);
  std::vector<int>&faces = mesh.file.face_index, &corners = mesh.file.corner_index;
  faces.resize(given.face_offsets.size() - 1);
  corners.resize(given.corner_vertices.size());
  std::iota(faces.begin(), faces.end(), 0);
  std::iota(corners.begin(), corners.end(), 0);
  merge_repeated_corners(mesh, faces, corners);
  if (mesh.corner_vertices.size() == given.corner_vertices.size()) faces = corners = {};
  return mesh;
}

}  // namespace holomorph::mesh
