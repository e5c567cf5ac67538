#include "choice/turned_parts.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include "mesh/make_surface.h"

namespace holomorph::choice {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

}  // namespace

PartPointer part_of_faces(std::vector<std::array<double, 3>> vertices, const std::vector<std::vector<int>>& faces) {
  mesh::Polygons polygons{std::move(vertices), {}, {0}};
  for (const std::vector<int>& face : faces) {
    polygons.corner_vertices.insert(polygons.corner_vertices.end(), face.begin(), face.end());
    polygons.face_offsets.push_back(static_cast<int>(polygons.corner_vertices.size()));
  }
  Execution execution(1);
  auto surface = std::make_shared<const mesh::Surface>(mesh::make_surface(std::move(polygons), execution));
  return part_of(std::move(surface), uv::Up::kZ, {}, execution);
}

PartPointer turned_part(const std::vector<Ring>& rings, int n, bool is_round,
                        const std::function<bool(int, int)>& is_there,
                        const std::function<double(const std::array<double, 3>&)>& factor) {
  std::vector<std::array<double, 3>> vertices;
  std::vector<int> first;  // vertex of each ring
  for (const auto& [radius, height] : rings) {
    first.push_back(static_cast<int>(vertices.size()));
    for (int i = 0; i < (radius > 0 ? n : 1); ++i)
      vertices.push_back({radius * std::cos(kTurn * i / n), radius * std::sin(kTurn * i / n), height});
  }
  for (std::array<double, 3>& point : vertices) {
    const double times = factor ? factor(point) : 1;
    for (double& x : point) x *= times;
  }
  const auto at = [&](int ring, int i) { return first[ring] + (rings[ring][0] > 0 ? i % n : 0); };
  const int count = static_cast<int>(rings.size());
  std::vector<std::vector<int>> faces;
  for (int ring = 0; ring < (is_round ? count : count - 1); ++ring) {
    const int next = (ring + 1) % count;
    for (int i = 0; i < n; ++i) {
      if (is_there && !is_there(ring, i)) continue;
      std::vector<int> face;
      for (const int v : {at(ring, i), at(ring, i + 1), at(next, i + 1), at(next, i)}) {
        if (face.empty() || (face.back() != v && face.front() != v)) face.push_back(v);
      }
      faces.push_back(std::move(face));
    }
  }
  return part_of_faces(std::move(vertices), faces);
}

PartPointer tube(int rings, int n, const std::function<bool(int, int)>& is_there) {
  std::vector<Ring> all;
  for (int k = 0; k <= rings; ++k) all.push_back({1, 2.0 * k / rings - 1});
  return turned_part(all, n, false, is_there);
}

PartPointer torus(int n, int m) {
  std::vector<Ring> all;
  for (int k = 0; k < m; ++k) all.push_back({2 + std::cos(kTurn * k / m), std::sin(kTurn * k / m)});
  return turned_part(all, n, true);
}

PartPointer limb() {
  constexpr int kRings = 16;
  constexpr double kLonger = 6, kFrom = 0.3;
  std::vector<Ring> all;
  for (int k = 0; k <= kRings; ++k) {
    const bool is_tip = k == 0 || k == kRings;
    const double angle = kTurn / 2 * k / kRings, z = -std::cos(angle);
    all.push_back({is_tip ? 0 : std::sin(angle), z + kLonger * std::max(z - kFrom, 0.0)});
  }
  return turned_part(all, 24);
}

}  // namespace holomorph::choice
