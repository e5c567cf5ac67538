#include "mesh/input_filter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "base/errors.h"
#include "base/workers.h"
#include "mesh/triangle_geometry.h"

namespace holomorph::mesh {
namespace {

// Half-edges are numbered by int, two for each side of a triangle: this bound keeps them in range.
constexpr std::int64_t kMaxCorners = std::numeric_limits<int>::max() / 8;

using std::to_string;

template <class Index>
void check_arrays(const BasicPolygons<Index>& mesh) {
  const auto corners = static_cast<std::int64_t>(mesh.corner_vertices.size());
  const auto& offsets = mesh.face_offsets;
  if (offsets.size() < 2) throw InvalidMesh("the mesh has no faces");
  if (corners > kMaxCorners || static_cast<std::int64_t>(mesh.vertices.size()) > kMaxCorners) {
    throw InvalidMesh("the mesh has more than " + to_string(kMaxCorners) +
                      " corners or vertices, too many for 32-bit indices");
  }
  if (offsets.front() != 0 || offsets.back() != corners) {
    throw InvalidMesh("face_offsets must run from 0 to the number of corners " + to_string(corners) + ", not from " +
                      to_string(offsets.front()) + " to " + to_string(offsets.back()));
  }
  for (std::size_t f = 0; f + 1 < offsets.size(); ++f) {
    if (offsets[f + 1] < offsets[f]) throw InvalidMesh("face_offsets decrease at face " + to_string(f));
  }
}

double largest_coordinate(const std::array<double, 3>& point) {
  return std::max({std::abs(point[0]), std::abs(point[1]), std::abs(point[2])});
}

bool is_usable(const std::array<double, 3>& point) {  // NaN: no comparison holds
  return std::abs(point[0]) <= kLargest && std::abs(point[1]) <= kLargest && std::abs(point[2]) <= kLargest;
}

template <class Index>
std::string fault_of_vertex(const BasicPolygons<Index>& mesh, std::int64_t vertex) {
  const std::array<double, 3>& point = mesh.vertices[static_cast<std::size_t>(vertex)];
  const std::string name = "vertex " + mesh.file.vertex(vertex);
  for (const double x : point) {
    if (!std::isfinite(x)) {
      return name + " has a coordinate that is " + (std::isnan(x) ? "not a number" : "infinite");
    }
  }
  return is_usable(point) ? "" : name + " has a coordinate beyond 1e60: scale the mesh down";
}

template <class Index>
std::span<const Index> corners_of(const BasicPolygons<Index>& mesh, int face) {
  return {mesh.corner_vertices.data() + mesh.face_offsets[face],
          mesh.corner_vertices.data() + mesh.face_offsets[face + 1]};
}

template <class Index>
bool are_vertices(const BasicPolygons<Index>& mesh, std::span<const Index> corners) {
  const auto count = static_cast<Index>(mesh.vertices.size());
  return std::all_of(corners.begin(), corners.end(), [&](Index v) { return v >= 0 && v < count; });
}

template <class Index>
bool has_three_vertices(std::span<const Index> corners) {
  const Index a = corners.empty() ? Index(-1) : corners[0];
  const auto b = std::find_if(corners.begin(), corners.end(), [&](Index v) { return v != a; });
  return std::any_of(b, corners.end(), [&](Index v) { return v != a && v != *b; });
}

template <class Index>
FaceFault fault_kind(const BasicPolygons<Index>& mesh, int face) {
  const auto corners = corners_of(mesh, face);
  if (!are_vertices(mesh, corners)) return FaceFault::kNoSuchVertex;
  const auto is_finite = [&](Index v) { return is_usable(mesh.vertices[v]); };
  if (!std::all_of(corners.begin(), corners.end(), is_finite)) return FaceFault::kNotFinite;
  return has_three_vertices(corners) ? FaceFault::kNone : FaceFault::kFewVertices;
}

// A vertex that occurs twice, or -1.
template <class Index>
Index vertex_met_twice(std::span<const Index> corners) {
  std::vector<Index> sorted(corners.begin(), corners.end());
  std::sort(sorted.begin(), sorted.end());
  const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
  return twice == sorted.end() ? -1 : *twice;
}

template <class Index>
bool is_sound(const BasicPolygons<Index>& mesh, int face) {
  const auto corners = corners_of(mesh, face);
  if (corners.size() < 3 || !are_vertices(mesh, corners)) return false;
  if (corners.size() > 3) return vertex_met_twice(corners) < 0;
  const Index a = corners[0], b = corners[1], c = corners[2];
  return a != b && b != c && c != a;
}

template <class Index>
std::string fault_of(const BasicPolygons<Index>& mesh, int face) {
  const auto vertex_count = static_cast<Index>(mesh.vertices.size());
  const auto corners = corners_of(mesh, face);
  const std::string name = "face " + mesh.file.face(face);
  if (corners.size() < 3) return name + " has " + to_string(corners.size()) + " corners; it needs at least 3";
  for (const Index v : corners) {
    if (v < 0) return name + " has the negative vertex index " + mesh.file.vertex(v);
    if (v >= vertex_count) {
      return name + " names vertex " + mesh.file.vertex(v) + "; numbers from " + mesh.file.vertex(0) + " to below " +
             mesh.file.vertex(vertex_count) + " are needed";
    }
  }
  for (const Index v : corners) {
    if (!is_usable(mesh.vertices[v])) return fault_of_vertex(mesh, v);
  }
  const Index v = vertex_met_twice(corners);
  return v >= 0 ? name + " has vertex " + mesh.file.vertex(v) + " twice" : "";
}

template <class Index>
void check(const BasicPolygons<Index>& mesh, Workers& workers) {
  check_arrays(mesh);
  const int vertices = static_cast<int>(mesh.vertices.size()), faces = static_cast<int>(mesh.face_offsets.size()) - 1;
  const int bad_vertex = first_row(workers, vertices, [&](int v) { return !is_usable(mesh.vertices[v]); });
  if (bad_vertex < vertices) throw InvalidMesh(fault_of_vertex(mesh, bad_vertex));
  const auto is_above = [&](double least) {
    return first_row(workers, vertices, [&](int v) { return largest_coordinate(mesh.vertices[v]) > least; }) < vertices;
  };
  if (!is_above(kSmallest) && is_above(0)) throw InvalidMesh("all coordinates are below 1e-60: scale the mesh up");
  const int bad_face = first_row(workers, faces, [&](int f) { return !is_sound(mesh, f); });
  if (bad_face < faces) throw InvalidMesh(fault_of(mesh, bad_face));
}

constexpr std::size_t kSample = 1024;  // corners
constexpr double kNearSample = 1e-3;   // of kWild: whatever the sample, there is no gap by kWild

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

enum class Where : char { kUnusable, kInside, kOutside };

template <class Index>
std::vector<Where> places(const BasicPolygons<Index>& mesh) {
  const auto points = corner_points(mesh, 1);
  const Point centre = median(points);
  const double size = size_of_bulk(distances(points, centre));
  if (size == 0) return {};
  std::vector<Where> result;
  for (const Point& p : mesh.vertices) {
    const bool is_inside = largest_difference(p, centre) <= size;
    result.push_back(!is_usable(p) ? Where::kUnusable : is_inside ? Where::kInside : Where::kOutside);
  }
  return result;
}

template <class Index>
std::vector<int> found(const BasicPolygons<Index>& mesh) {
  if (!may_be_wild(mesh)) return {};
  const std::vector<Where> place = places(mesh);
  if (place.empty()) return {};
  const auto corners = [&](std::size_t f) {
    return std::span(mesh.corner_vertices)
        .subspan(mesh.face_offsets[f], mesh.face_offsets[f + 1] - mesh.face_offsets[f]);
  };
  const auto is_at = [&](Index v, Where where) {
    return v >= 0 && v < static_cast<Index>(place.size()) && place[v] == where;
  };
  const std::size_t faces = mesh.face_offsets.size() - 1;
  std::vector<char> is_wild(place.size(), 0);
  for (std::size_t f = 0; f < faces; ++f) {
    const auto own = corners(f);
    if (std::none_of(own.begin(), own.end(), [&](Index v) { return is_at(v, Where::kInside); })) continue;
    for (const Index v : own) {
      if (is_at(v, Where::kOutside)) is_wild[v] = 1;
    }
  }
  bool has_others = false;
  for (std::size_t f = 0; f < faces && !has_others; ++f) {
    const auto own = corners(f);
    has_others = !own.empty() && std::all_of(own.begin(), own.end(), [&](Index v) {
      return v >= 0 && v < static_cast<Index>(place.size()) && place[v] != Where::kUnusable && !is_wild[v];
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
bool has_any_of(const BasicPolygons<Index>& mesh, int face, const std::vector<int>& vertices) {
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
    const bool is_wild = !wild.empty() && fault == FaceFault::kNone && has_any_of(given, f, wild);
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

void check_layout(const Polygons& mesh) { check_arrays(mesh); }
void check_layout(const GivenPolygons& mesh) { check_arrays(mesh); }
FaceFault fault_of_face(const Polygons& mesh, int face) { return fault_kind(mesh, face); }
FaceFault fault_of_face(const GivenPolygons& mesh, int face) { return fault_kind(mesh, face); }
std::string fault_text(const Polygons& mesh, int face) { return fault_of(mesh, face); }
std::string fault_text(const GivenPolygons& mesh, int face) { return fault_of(mesh, face); }
void check_polygons(const Polygons& mesh, Workers& workers) { check(mesh, workers); }
void check_polygons(const GivenPolygons& mesh, Workers& workers) { check(mesh, workers); }

std::vector<int> wild_vertices(const Polygons& polygons) { return found(polygons); }
std::vector<int> wild_vertices(const GivenPolygons& polygons) { return found(polygons); }

UsableFaces usable_faces(GivenPolygons polygons) { return usable(std::move(polygons)); }
UsableFaces usable_faces(Polygons polygons) { return usable(std::move(polygons)); }
void refuse_wild_vertices(const Polygons& polygons) { refuse_wild(polygons); }
void refuse_wild_vertices(const GivenPolygons& polygons) { refuse_wild(polygons); }

}  // namespace holomorph::mesh
