#include "mesh/input_filter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "base/errors.h"
#include "mesh/polygon_checks.h"
#include "mesh/triangle_geometry.h"

namespace holomorph::mesh {
namespace {

using Point = std::array<double, 3>;

constexpr std::size_t kSample = 1024;  // corners
constexpr double kNearSample = 1e-3;   // of kWild: whatever the sample, there is no gap by kWild

double largest_difference(const Point& a, const Point& b) {
  return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

bool is_usable(const Point& p) { return largest_difference(p, {}) <= kLargest; }  // not for NaN

// The usable points of every n-th corner.
template <class Index>
std::vector<Point> corner_points(const BasicPolygons<Index>& mesh, std::size_t n) {
  std::vector<Point> points;
  for (std::size_t c = 0; c < mesh.corner_vertices.size(); c += n) {
    const Index v = mesh.corner_vertices[c];
    if (v >= 0 && v < static_cast<Index>(mesh.vertices.size()) && is_usable(mesh.vertices[v]))
      points.push_back(mesh.vertices[v]);
  }
  return points;
}

Point median(const std::vector<Point>& points) {
  Point result{};
  std::vector<double> values(points.size());
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < points.size(); ++i) values[i] = points[i][axis];
    std::nth_element(values.begin(), values.begin() + std::ssize(values) / 2, values.end());
    result[axis] = values[values.size() / 2];
  }
  return result;
}

// The distances of the points from one, ascending.
std::vector<double> distances(const std::vector<Point>& points, const Point& from) {
  std::vector<double> result;
  for (const Point& p : points) result.push_back(largest_difference(p, from));
  std::sort(result.begin(), result.end());
  return result;
}

template <class Index>
bool may_be_wild(const BasicPolygons<Index>& mesh) {
  const auto points = corner_points(mesh, mesh.corner_vertices.size() / kSample + 1);
  if (points.empty()) return false;
  const Point centre = median(points);
  const double least = kNearSample * kWild * distances(points, centre)[points.size() / 2];
  return std::any_of(mesh.vertices.begin(), mesh.vertices.end(),
                     [&](const Point& p) { return is_usable(p) && largest_difference(p, centre) > least; });
}

// The size of the bulk, 0 where there is no gap.
double size_of_bulk(const std::vector<double>& ascending) {
  for (std::size_t k = (ascending.size() - 1) / 2; k + 1 < ascending.size(); ++k) {
    if (ascending[k] > 0 && ascending[k + 1] > kWild * ascending[k]) return ascending[k];
  }
  return 0;
}

enum class Place : char { kUnusable, kInside, kOutside };

template <class Index>
std::vector<Place> places(const BasicPolygons<Index>& mesh) {
  const auto points = corner_points(mesh, 1);
  const Point centre = median(points);
  const double size = size_of_bulk(distances(points, centre));
  if (size == 0) return {};
  std::vector<Place> result;
  for (const Point& p : mesh.vertices) {
    const bool is_inside = largest_difference(p, centre) <= size;
    result.push_back(!is_usable(p) ? Place::kUnusable : is_inside ? Place::kInside : Place::kOutside);
  }
  return result;
}

template <class Index>
std::vector<int> found(const BasicPolygons<Index>& mesh) {
  if (!may_be_wild(mesh)) return {};
  const std::vector<Place> place = places(mesh);
  if (place.empty()) return {};
  const auto corners = [&](std::size_t f) {
    return std::span(mesh.corner_vertices)
        .subspan(mesh.face_offsets[f], mesh.face_offsets[f + 1] - mesh.face_offsets[f]);
  };
  const auto is_at = [&](Index v, Place where) {
    return v >= 0 && v < static_cast<Index>(place.size()) && place[v] == where;
  };
  const std::size_t faces = mesh.face_offsets.size() - 1;
  std::vector<char> is_wild(place.size(), 0);
  for (std::size_t f = 0; f < faces; ++f) {
    const auto own = corners(f);
    if (std::none_of(own.begin(), own.end(), [&](Index v) { return is_at(v, Place::kInside); })) continue;
    for (const Index v : own) {
      if (is_at(v, Place::kOutside)) is_wild[v] = 1;
    }
  }
  bool has_others = false;
  for (std::size_t f = 0; f < faces && !has_others; ++f) {
    const auto own = corners(f);
    has_others = !own.empty() && std::all_of(own.begin(), own.end(), [&](Index v) {
      return v >= 0 && v < static_cast<Index>(place.size()) && place[v] != Place::kUnusable && !is_wild[v];
    });
  }
  std::vector<int> result;
  for (std::size_t v = 0; has_others && v < is_wild.size(); ++v) {
    if (is_wild[v]) result.push_back(static_cast<int>(v));
  }
  return result;
}

// Vertices that do not exist become -1.
template <class Index>
Polygons with_existing_vertices(BasicPolygons<Index> given) {
  Polygons mesh{std::move(given.vertices), {}, {given.face_offsets.begin(), given.face_offsets.end()}};
  mesh.corner_vertices.reserve(given.corner_vertices.size());
  const auto count = static_cast<Index>(mesh.vertices.size());
  for (const Index v : given.corner_vertices)
    mesh.corner_vertices.push_back(v >= 0 && v < count ? static_cast<int>(v) : -1);
  return mesh;
}

template <class Index>
bool has_one_of(const BasicPolygons<Index>& mesh, int face, const std::vector<int>& vertices) {
  const auto end = mesh.corner_vertices.begin() + mesh.face_offsets[face + 1];
  return std::any_of(mesh.corner_vertices.begin() + mesh.face_offsets[face], end, [&](Index v) {
    return std::binary_search(vertices.begin(), vertices.end(), static_cast<int>(v));
  });
}

std::string wild_text(const FileRecord& file, int vertex) {
  return "vertex " + file.vertex(vertex) + " is more than 1e9 times as far away as the mesh is large";
}

template <class Index>
void refuse_wild(const BasicPolygons<Index>& mesh) {
  const std::vector<int> wild = wild_vertices(mesh);
  if (!wild.empty()) throw InvalidMesh(wild_text(mesh.file, wild.front()));
}

template <class Index>
UsableFaces usable(BasicPolygons<Index> given) {
  std::array<RefusedFaces, 5> by_fault;  // those with wild vertices are the last
  const std::vector<int> wild = wild_vertices(given);
  if (!wild.empty()) by_fault.back().reason = wild_text(given.file, wild.front());
  std::vector<int> faces;
  for (int f = 0; f + 1 < static_cast<int>(given.face_offsets.size()); ++f) {
    const FaceFault fault = fault_of_face(given, f);
    RefusedFaces& refused = by_fault[static_cast<std::size_t>(fault)];
    if (fault != FaceFault::kNone && refused.faces.empty()) refused.reason = fault_text(given, f);
    const bool is_wild = !wild.empty() && fault == FaceFault::kNone && has_one_of(given, f, wild);
    (is_wild ? by_fault.back().faces : fault == FaceFault::kNone ? faces : refused.faces).push_back(f);
  }
  const Polygons mesh = with_existing_vertices(std::move(given));
  UsableFaces result{PolygonParts(mesh).take(std::move(faces)), {}};
  for (RefusedFaces& refused : by_fault) {
    if (!refused.faces.empty()) result.refused.push_back(std::move(refused));
  }
  return result;
}

}  // namespace

std::vector<int> wild_vertices(const Polygons& polygons) { return found(polygons); }
std::vector<int> wild_vertices(const GivenPolygons& polygons) { return found(polygons); }

UsableFaces usable_faces(GivenPolygons polygons) { return usable(std::move(polygons)); }
UsableFaces usable_faces(Polygons polygons) { return usable(std::move(polygons)); }
void refuse_wild_vertices(const Polygons& polygons) { refuse_wild(polygons); }
void refuse_wild_vertices(const GivenPolygons& polygons) { refuse_wild(polygons); }

}  // namespace holomorph::mesh
