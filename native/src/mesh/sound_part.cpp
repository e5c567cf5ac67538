#include "mesh/sound_part.h"

#include <algorithm>
#include <exception>
#include <map>
#include <numeric>
#include <tuple>

#include "base/errors.h"
#include "mesh/make_surface.h"
#include "mesh/polygon_checks.h"
#include "mesh/polygon_edges.h"
#include "mesh/polygon_parts.h"

namespace holomorph::mesh {
namespace {

// Elements joined to sets, each known by its lowest element.
class JoinedSets {
 public:
  explicit JoinedSets(std::size_t count) : lower_(count) { std::iota(lower_.begin(), lower_.end(), 0); }

  int lowest(int i) {
    while (lower_[i] != i) i = lower_[i] = lower_[lower_[i]];
    return i;
  }
  void join(int i, int j) {
    const int a = lowest(i), b = lowest(j);
    lower_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<int> lower_;
};

struct Side {
  int lower, higher;                // its vertices
  int lower_corner, higher_corner;  // its corners there
};

// By their vertices; without those of vertices that do not exist.
std::vector<Side> sorted_sides(const Polygons& mesh) {
  std::vector<Side> sides;
  for (std::size_t f = 0; f + 1 < mesh.face_offsets.size(); ++f) {
    const int first = mesh.face_offsets[f], last = mesh.face_offsets[f + 1];
    for (int c = first; c < last; ++c) {
      const int next = c + 1 == last ? first : c + 1, a = mesh.corner_vertices[c], b = mesh.corner_vertices[next];
      if (std::min(a, b) >= 0) sides.push_back(a < b ? Side{a, b, c, next} : Side{b, a, next, c});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.lower, a.higher, a.lower_corner) < std::tie(b.lower, b.higher, b.lower_corner);
  });
  return sides;
}

// A mesh that is refused as a whole, with the vertices between fans split.
struct Split {
  Polygons polygons;
  std::vector<int> vertex_index;             // as given, of each vertex
  std::vector<std::vector<int>> components;  // their faces, by first face
};

Split split(const Polygons& mesh) {
  const std::vector<int> face_of = corner_faces(mesh);
  JoinedSets fans(mesh.corner_vertices.size()), parts(mesh.face_offsets.size() - 1);
  const std::vector<Side> sides = sorted_sides(mesh);
  for (std::size_t i = 1; i < sides.size(); ++i) {
    const Side &a = sides[i - 1], &b = sides[i];
    if (a.lower != b.lower || a.higher != b.higher) continue;
    fans.join(a.lower_corner, b.lower_corner);
    fans.join(a.higher_corner, b.higher_corner);
    parts.join(face_of[a.lower_corner], face_of[b.lower_corner]);
  }
  Split result{mesh, std::vector<int>(mesh.vertices.size()), {}};
  std::iota(result.vertex_index.begin(), result.vertex_index.end(), 0);
  std::vector<char> taken(mesh.vertices.size(), 0);
  for (std::size_t c = 0; c < mesh.corner_vertices.size(); ++c) {
    const int v = mesh.corner_vertices[c], fan = fans.lowest(static_cast<int>(c));
    if (v < 0) continue;
    int& vertex = result.polygons.corner_vertices[c];
    if (fan < static_cast<int>(c)) {
      vertex = result.polygons.corner_vertices[fan];
    } else if (std::exchange(taken[v], 1)) {
      vertex = static_cast<int>(result.vertex_index.size());
      result.vertex_index.push_back(v);
      result.polygons.vertices.push_back(mesh.vertices[v]);
    }
  }
  std::map<int, std::vector<int>> components;
  for (int f = 0; f + 1 < static_cast<int>(mesh.face_offsets.size()); ++f) components[parts.lowest(f)].push_back(f);
  for (auto& [first, faces] : components) result.components.push_back(std::move(faces));
  return result;
}

// Why a component is no surface; empty if it is one.
std::string fault(PolygonPart part, const std::vector<int>& vertex_index, Execution& execution) {
  for (int& v : part.vertex_index) v = vertex_index[v];
  Surface surface;
  surface.polygons = std::move(part.polygons);
  try {
    check_polygons(surface.polygons, execution.workers());
    complete(surface, {Labels(part.vertex_index), Labels(part.face_index)}, execution);
  } catch (const InvalidMesh& error) {
    return error.what();
  } catch (const TopologyError& error) {
    return error.what();
  }
  return {};
}

// @param faults of single faces. @param failure what the whole mesh was refused with
SoundPart rescued(const Polygons& mesh, const std::map<int, std::string>& faults, const std::exception_ptr& failure,
                  Execution& execution) {
  const Split parts = split(mesh);
  PolygonParts cutter(parts.polygons);
  SoundPart result;
  result.given_vertex_count = static_cast<int>(mesh.vertices.size());
  std::vector<int> sound;
  for (const std::vector<int>& faces : parts.components) {
    const auto bad = std::find_if(faces.begin(), faces.end(), [&](int f) { return faults.contains(f); });
    std::string reason =
        bad != faces.end() ? faults.at(*bad) : fault(cutter.take(faces), parts.vertex_index, execution);
    if (reason.empty())
      sound.insert(sound.end(), faces.begin(), faces.end());
    else
      result.refused.push_back({faces, std::move(reason)});
  }
  if (sound.empty()) std::rethrow_exception(failure);
  std::sort(sound.begin(), sound.end());
  PolygonPart part = cutter.take(std::move(sound));
  result.surface = make_surface(std::move(part.polygons), execution);
  result.face_index = std::move(part.face_index);
  result.corner_index = std::move(part.corner_index);
  for (const int v : part.vertex_index) result.vertex_index.push_back(parts.vertex_index[v]);
  std::vector<int> given = result.vertex_index;
  std::sort(given.begin(), given.end());
  for (std::size_t i = 1; i < given.size(); ++i) {
    auto& split = result.split_vertices;
    if (given[i] == given[i - 1] && (split.empty() || split.back() != given[i])) split.push_back(given[i]);
  }
  return result;
}

// Of each face that cannot be part of a surface.
template <class Index>
std::map<int, std::string> faults_of_faces(const BasicPolygons<Index>& mesh) {
  std::map<int, std::string> faults;
  for (int f = 0; f + 1 < static_cast<int>(mesh.face_offsets.size()); ++f) {
    if (std::string fault = fault_of_face(mesh, f); !fault.empty()) faults.emplace(f, std::move(fault));
  }
  return faults;
}

// Vertices that do not exist become -1. @pre check_layout has passed
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
SoundPart sound_part_of(BasicPolygons<Index> given, Execution& execution) {
  check_layout(given);
  try {
    check_polygons(given, execution.workers());
  } catch (const InvalidMesh&) {
    const std::exception_ptr failure = std::current_exception();
    const auto faults = faults_of_faces(given);
    return rescued(with_existing_vertices(std::move(given)), faults, failure, execution);
  }
  SoundPart result;
  result.surface.polygons = narrowed(std::move(given));
  std::exception_ptr failure;
  try {
    complete(result.surface, {}, execution);
    result.given_vertex_count = result.surface.vertex_count;
    return result;
  } catch (const InvalidMesh&) {
    failure = std::current_exception();
  } catch (const TopologyError&) {
    failure = std::current_exception();
  }
  return rescued(result.surface.polygons, {}, failure, execution);
}

}  // namespace

SoundPart sound_part(Polygons polygons, Execution& execution) { return sound_part_of(std::move(polygons), execution); }
SoundPart sound_part(GivenPolygons polygons, Execution& execution) {
  return sound_part_of(std::move(polygons), execution);
}

}  // namespace holomorph::mesh
