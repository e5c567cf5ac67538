#include "mesh/cutting.h"

#include <algorithm>
#include <exception>
#include <numeric>
#include <utility>

#include "base/errors.h"
#include "mesh/input_filter.h"
#include "mesh/make_surface.h"
#include "mesh/polygon_edges.h"
#include "mesh/triangle_geometry.h"
#include "mesh/welding.h"

namespace holomorph::mesh {
namespace {

template <class T>
void make_ascending(std::vector<T>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

// Names cuts by elements of the mesh as given.
class Recorder {
 public:
  explicit Recorder(const PolygonPart& part) : part_(part) {}

  std::vector<Cut> cuts(const CornerLabels& labels, const SideJoins& joins, const std::vector<int>& corner_vertices) {
    std::vector<Cut> found(6);
    found[0] = {CutReason::kManyFaces, {}, edges(joins.many), {}};
    found[1] = {CutReason::kTwice, {}, {}, faces(labels.twice)};
    found[2] = {CutReason::kOpposite, {}, {}, faces(labels.opposite)};
    found[3] = {CutReason::kOneSided, {}, edges(joins.sided), {}};
    found[4] = {CutReason::kRepeated, {}, {}, faces(labels.repeated)};
    found[5] = {CutReason::kTouching, touching(corner_vertices), {}, {}};
    std::erase_if(found, [](const Cut& c) { return c.vertices.empty() && c.edges.empty() && c.faces.empty(); });
    return found;
  }

 private:
  int vertex(int corner) const { return part_.vertex_index[part_.polygons.corner_vertices[corner]]; }

  std::vector<Pair> edges(const std::vector<std::vector<int>>& by_edge) {
    const std::vector<int>& offsets = part_.polygons.face_offsets;
    std::vector<Pair> result;
    for (const auto& sides : by_edge) {
      for (const int s : sides) {
        const int face = static_cast<int>(std::upper_bound(offsets.begin(), offsets.end(), s) - offsets.begin()) - 1;
        const int a = vertex(s), b = vertex(s + 1 == offsets[face + 1] ? offsets[face] : s + 1);
        result.push_back({std::min(a, b), std::max(a, b)});
        named_.insert(named_.end(), {a, b});
      }
    }
    make_ascending(result);
    return result;
  }

  std::vector<int> faces(const std::vector<int>& own) {
    const Polygons& mesh = part_.polygons;
    std::vector<int> result;
    for (const int f : own) {
      result.push_back(part_.face_index[f]);
      for (int c = mesh.face_offsets[f]; c < mesh.face_offsets[f + 1]; ++c) named_.push_back(vertex(c));
    }
    return result;
  }

  // Vertices that are several, without those of what is named already.
  std::vector<int> touching(const std::vector<int>& corner_vertices) {
    std::vector<Pair> places(corner_vertices.size());
    for (int c = 0; c < static_cast<int>(places.size()); ++c) places[c] = {vertex(c), corner_vertices[c]};
    make_ascending(places);
    make_ascending(named_);
    std::vector<int> result;
    for (std::size_t i = 1; i < places.size(); ++i) {
      const int v = places[i][0];
      if (places[i - 1][0] == v && !std::binary_search(named_.begin(), named_.end(), v)) result.push_back(v);
    }
    make_ascending(result);
    return result;
  }

  const PolygonPart& part_;
  std::vector<int> named_;  // vertices of cuts so far
};

// A vertex for each fan, ordered by the vertices that these were.
CutSurface numbered(UsableFaces usable, const Plan& plan, Execution& execution) {
  PolygonPart& part = usable.part;
  Polygons& mesh = part.polygons;
  const std::vector<int>& fan = plan.joins.fan;
  const int corners = static_cast<int>(fan.size());
  std::vector<int> least(corners, static_cast<int>(mesh.vertices.size()));  // vertex of each fan
  for (int c = 0; c < corners; ++c) least[fan[c]] = std::min(least[fan[c]], mesh.corner_vertices[c]);
  std::vector<Pair> fans;
  for (int c = 0; c < corners; ++c) {
    if (fan[c] == c) fans.push_back({least[c], c});
  }
  std::sort(fans.begin(), fans.end());
  CutSurface result;
  std::vector<int> number(corners, -1);
  Polygons cut{{}, std::vector<int>(corners), mesh.face_offsets};
  for (const auto& [v, root] : fans) {
    number[root] = static_cast<int>(cut.vertices.size());
    cut.vertices.push_back(mesh.vertices[v]);
    result.vertex_index.push_back(part.vertex_index[v]);
  }
  for (int c = 0; c < corners; ++c) {
    cut.corner_vertices[c] = number[fan[c]];
    if (mesh.corner_vertices[c] != least[fan[c]])
      result.joined_vertices.push_back({part.vertex_index[mesh.corner_vertices[c]], part.vertex_index[least[fan[c]]]});
  }
  make_ascending(result.joined_vertices);
  const auto same = [](const Pair& a, const Pair& b) { return a[0] == b[0]; };
  const auto end = std::unique(result.joined_vertices.begin(), result.joined_vertices.end(), same);
  result.joined_vertices.erase(end, result.joined_vertices.end());
  result.cuts = cuts(part, plan.labels, plan.joins, cut.corner_vertices);
  result.surface = make_surface(std::move(cut), execution);
  result.face_index = std::move(part.face_index);
  result.corner_index = std::move(part.corner_index);
  result.refused = std::move(usable.refused);
  return result;
}

// Makes corners that are one, or lie at the ends of a side that is a point, one, where a face is left.
CutSurface cut(UsableFaces usable, Execution& execution) {
  std::vector<int> vertex = without_point_sides(usable.part.polygons);
  PolygonPart part = usable.part;
  for (int& v : part.polygons.corner_vertices) v = vertex[v];
  RepeatedCorners repeated = merge_repeated_corners(part.polygons, part.face_index, part.corner_index);
  if (part.face_index.empty()) {
    part = usable.part;
    repeated = {};
    std::iota(vertex.begin(), vertex.end(), 0);
  }
  std::vector<Pair> joined;
  for (int v = 0; v < static_cast<int>(vertex.size()); ++v) {
    if (vertex[v] != v) joined.push_back({part.vertex_index[v], part.vertex_index[vertex[v]]});
  }
  usable.part = std::move(part);
  const Plan plan = welded_plan(usable.part.polygons);
  CutSurface result = numbered(std::move(usable), plan, execution);
  const std::vector<Pair> further = result.joined_vertices;
  for (Pair& pair : joined) {  // where the vertex that stands for it was joined with a lower one in its turn
    const auto found = std::lower_bound(further.begin(), further.end(), Pair{pair[1], -1});
    if (found != further.end() && (*found)[0] == pair[1]) pair[1] = (*found)[1];
    result.joined_vertices.push_back(pair);
  }
  make_ascending(result.joined_vertices);
  result.repeated_corners = std::move(repeated.corners);
  result.point_faces = std::move(repeated.faces);
  return result;
}

// #components whether all triangles are degenerate.
std::vector<char> flat_components(const Surface& surface) {
  std::vector<char> flat(surface.component_count, 1);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& [a, b, c] = surface.triangle_edges[t];
    const auto& l = surface.edge_lengths;
    if (!is_degenerate(l[a], l[b], l[c])) flat[surface.face_component[surface.triangle_faces[t]]] = 0;
  }
  return flat;
}

std::vector<int> indices_in(const std::vector<int>& whole, std::vector<int> part) {
  if (!whole.empty()) {
    for (int& i : part) i = whole[i];
  }
  return part;
}

// The rest of a surface that has parts without area.
CutSurface without_flat_parts(CutSurface given, const FileRecord& file, Execution& execution) {
  if (given.surface.repairs.zero_area_faces.empty()) return given;
  const std::vector<char> flat = flat_components(given.surface);
  if (std::find(flat.begin(), flat.end(), 1) == flat.end()) return given;
  std::vector<int> faces, rest;
  for (int f = 0; f < static_cast<int>(given.surface.face_component.size()); ++f)
    (flat[given.surface.face_component[f]] ? faces : rest).push_back(f);
  PolygonPart part = PolygonParts(given.surface.polygons).take(std::move(rest));
  faces = indices_in(given.face_index, std::move(faces));
  given.refused.push_back({faces, "face " + file.face(faces.front()) + " has no area, nor have faces beside it"});
  given.surface = make_surface(std::move(part.polygons), execution);
  given.vertex_index = indices_in(given.vertex_index, std::move(part.vertex_index));
  given.face_index = indices_in(given.face_index, std::move(part.face_index));
  given.corner_index = indices_in(given.corner_index, std::move(part.corner_index));
  return given;
}

// Why polygons cannot be taken as they are; null where they can.
template <class Index>
std::exception_ptr failure_of(const BasicPolygons<Index>& given, Execution& execution) {
  try {
    check_polygons(given, execution.workers());
    refuse_wild_vertices(given);
    return nullptr;
  } catch (const InvalidMesh&) {
    return std::current_exception();
  }
}

// The surface that the mesh is; without faces where it is none. @param failure why
CutSurface as_given(Polygons polygons, std::exception_ptr& failure, Execution& execution) {
  CutSurface result;
  result.surface.polygons = std::move(polygons);
  try {
    complete(result.surface, {}, execution);
  } catch (const InvalidMesh&) {
    failure = std::current_exception();
  } catch (const TopologyError&) {
    failure = std::current_exception();
  }
  return result;
}

template <class Index>
CutSurface cut_surface_of(BasicPolygons<Index> given, Execution& execution) {
  check_layout(given);
  const FileRecord file = given.file;
  const int vertex_count = static_cast<int>(given.vertices.size());
  CutSurface result;
  if (std::exception_ptr failure = failure_of(given, execution)) {
    UsableFaces usable = usable_faces(std::move(given));
    if (usable.part.face_index.empty()) std::rethrow_exception(failure);
    result = cut(std::move(usable), execution);
  } else {
    result = as_given(narrowed(std::move(given)), failure, execution);
    if (failure || meets_itself(result.surface)) {
      CutSurface made = cut(usable_faces(result.surface.polygons), execution);
      if (failure || !made.joined_vertices.empty()) result = std::move(made);
    }
  }
  result.given_vertex_count = vertex_count;
  return without_flat_parts(std::move(result), file, execution);
}

}  // namespace

std::vector<Cut> cuts(const PolygonPart& part, const CornerLabels& labels, const SideJoins& joins,
                      const std::vector<int>& corner_vertices) {
  return Recorder(part).cuts(labels, joins, corner_vertices);
}

CutSurface cut_surface(Polygons polygons, Execution& execution) {
  return cut_surface_of(std::move(polygons), execution);
}
CutSurface cut_surface(GivenPolygons polygons, Execution& execution) {
  return cut_surface_of(std::move(polygons), execution);
}

}  // namespace holomorph::mesh
