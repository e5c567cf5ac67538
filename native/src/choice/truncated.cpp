#include "choice/truncated.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <map>
#include <utility>

#include "base/errors.h"
#include "mesh/make_surface.h"
#include "mesh/surface.h"
#include "structure/pole_structure.h"

namespace holomorph::choice {
namespace {

using Point = std::array<double, 3>;

constexpr double kCut = 1.0 / 3;  // part of each edge at a pole that is cut off: less than half, both ends may be poles
constexpr double kSameUv = 1e-9;  // relative to the UV size: across an edge that is no seam UVs differ by rounding

Complex at(const uv::UvArray& uv, int corner) { return {uv(corner, 0), uv(corner, 1)}; }

double between(const Point& a, const Point& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

// The vertex farthest from the middle, and the one farthest from that; the first of equals. Between two polygons only,
// a vertex would get two triangles with the same vertices.
std::vector<int> far_corners(const mesh::Polygons& polygons) {
  const std::vector<Point>& points = polygons.vertices;
  std::vector<int> faces(points.size(), 0), allowed;
  for (const int v : polygons.corner_vertices) ++faces[v];
  Point middle{};
  for (int v = 0; v < std::ssize(points); ++v) {
    if (faces[v] > 2) allowed.push_back(v);
    for (int k = 0; k < 3; ++k) middle[k] += points[v][k];
  }
  for (double& each : middle) each /= static_cast<double>(points.size());
  const auto farthest = [&](const Point& from) {
    return held(std::ranges::max_element(allowed, {}, [&](int v) { return between(points[v], from); }), allowed);
  };
  const int one = farthest(middle);
  return {one, farthest(points[one])};
}

// The new vertices, one on each edge that leaves a vertex whose corners are cut off.
class Cuts {
 public:
  explicit Cuts(mesh::Polygons& refined) : refined_(refined) {}

  int towards(int vertex, int other) {
    const auto [place, is_new] = made_.try_emplace({vertex, other}, static_cast<int>(refined_.vertices.size()));
    if (is_new) {
      const Point start = refined_.vertices[vertex], end = refined_.vertices[other];
      Point& point = refined_.vertices.emplace_back();
      for (int k = 0; k < 3; ++k) point[k] = start[k] + kCut * (end[k] - start[k]);
    }
    return place->second;
  }

 private:
  mesh::Polygons& refined_;
  std::map<std::pair<int, int>, int> made_;
};

}  // namespace

Truncation truncated(const mesh::Polygons& polygons, const std::vector<int>& vertices) {
  Truncation result;
  mesh::Polygons& refined = result.polygons;
  refined.vertices = polygons.vertices;
  refined.face_offsets = {0};
  Cuts cuts(refined);
  std::vector<std::array<int, 3>> triangles;
  for (std::size_t f = 0; f + 1 < polygons.face_offsets.size(); ++f) {
    const int begin = polygons.face_offsets[f], count = polygons.face_offsets[f + 1] - begin;
    for (int i = 0; i < count; ++i) {
      const auto corner = [&](int k) { return polygons.corner_vertices[begin + (k + count) % count]; };
      const int vertex = corner(i);
      result.first.push_back(static_cast<int>(refined.corner_vertices.size()));
      if (std::ranges::find(vertices, vertex) == vertices.end()) {
        refined.corner_vertices.push_back(vertex);
        continue;
      }
      const int before = cuts.towards(vertex, corner(i - 1)), after = cuts.towards(vertex, corner(i + 1));
      refined.corner_vertices.insert(refined.corner_vertices.end(), {before, after});
      result.cut.push_back(begin + i);
      triangles.push_back({before, vertex, after});
    }
    refined.face_offsets.push_back(static_cast<int>(refined.corner_vertices.size()));
  }
  for (const auto& triangle : triangles) {
    const int begin = static_cast<int>(refined.corner_vertices.size());
    result.covers.push_back({begin, begin + 1, begin + 2});
    refined.corner_vertices.insert(refined.corner_vertices.end(), triangle.begin(), triangle.end());
    refined.face_offsets.push_back(begin + 3);
  }
  return result;
}

Truncated::Truncated(PartPointer part, const structure::Options& options, Execution& execution)
    : AnyStructure(MapKind::kLog, part, part->surface) {
  const mesh::Polygons& polygons = part->surface->polygons;
  const std::vector<int> poles = far_corners(polygons);
  truncation_ = truncated(polygons, poles);
  const auto surface = std::make_shared<const mesh::Surface>(mesh::make_surface(truncation_.polygons, execution));
  refined_ = std::make_unique<Forms>(
      MapKind::kLog, part_of(surface, part->up, {}, execution),
      structure::solved(options, execution, [&](const structure::Options& own, Execution& running) {
        return structure::pole_structure(surface, {poles, {}, {}}, own, running);
      }));
}

Eigen::VectorXcd Truncated::balanced_coefficients(Execution& execution) {
  return refined_->balanced_coefficients(execution);
}

uv::UvArray Truncated::uv(const Eigen::VectorXcd& coefficients, Execution& execution) {
  const uv::UvArray refined = refined_->uv(coefficients, execution);
  uv::UvArray result(std::ssize(truncation_.first), 2);
  for (Eigen::Index c = 0; c < result.rows(); ++c) result.row(c) = refined.row(truncation_.first[c]);
  for (std::size_t k = 0; k < truncation_.cut.size(); ++k) {
    const auto [a, apex, b] = truncation_.covers[k];
    const int corner = truncation_.cut[k], first = truncation_.first[corner];
    const Complex start = at(refined, first), end = at(refined, first + 1), foot = at(refined, a);
    const Complex z = start + (at(refined, apex) - foot) / (at(refined, b) - foot) * (end - start);
    result.row(corner) << z.real(), z.imag();
  }
  return result;
}

// The edges where the UVs of the two sides differ.
std::vector<int> Truncated::seams(Execution& execution) {
  const mesh::Surface& surface = *triangulation();
  const uv::UvArray uv = this->uv(balanced_coefficients(execution), execution);
  double size = 0;
  for (int c = 0; c < uv.rows(); ++c) size = std::max(size, std::abs(at(uv, c) - at(uv, 0)));
  const auto sides = mesh::edge_sides(surface);
  std::vector<int> result;
  for (int e = 0; e < std::ssize(sides); ++e) {
    const auto ends = [&](int side) {
      const mesh::Triple& corners = surface.triangle_corners[side / 3];
      return std::pair(at(uv, corners[side % 3]), at(uv, corners[(side + 1) % 3]));
    };
    const auto [start, end] = ends(sides[e][0]);
    const auto [other_end, other_start] = ends(sides[e][1]);  // which runs the other way
    if (std::max(std::abs(start - other_start), std::abs(end - other_end)) > kSameUv * size) result.push_back(e);
  }
  return result;
}

uv::Kept Truncated::kept(const Eigen::VectorXcd&, Execution&) {
  uv::Kept result;
  result.poles = poles();
  return result;
}

}  // namespace holomorph::choice
