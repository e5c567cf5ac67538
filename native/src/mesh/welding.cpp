#include "mesh/welding.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <tuple>
#include <utility>

#include "mesh/input_filter.h"
#include "mesh/polygon_edges.h"
#include "mesh/triangle_geometry.h"
#include "mesh/union_find.h"

namespace holomorph::mesh {
namespace {

constexpr double kOfSide = 0x1p-20;  // of the median side: points that are nearer are at one place
constexpr double kShift =
    0x1.a827999fcef32p-2;             // of the grid, irrational: decimals and floats lie on none of its borders
constexpr double kOfPlace = 0x1p-48;  // of the largest coordinate: what sums of a few coordinates are off by

// @param vertices #C vertex of each corner
Plan planned(const Polygons& mesh, const std::vector<int>& vertices) {
  Plan plan{corner_labels(vertices, mesh.face_offsets), {}};
  std::vector<int>& label = plan.labels.label;
  const auto crowded = crowded_edges(mesh, label);
  if (!crowded.empty()) {
    const std::vector<int> face_of = corner_faces(mesh);
    int count = *std::max_element(label.begin(), label.end()) + 1;
    std::vector<char> apart(mesh.face_offsets.size() - 1, 0);
    for (const auto& sides : crowded) {
      for (const int s : sides) apart[face_of[s]] = 1;
    }
    for (std::size_t c = 0; c < label.size(); ++c) {
      if (apart[face_of[c]]) label[c] = count++;
    }
  }
  plan.joins = join_sides(mesh, label);
  plan.joins.many.insert(plan.joins.many.end(), crowded.begin(), crowded.end());
  return plan;
}

// Sides without a partner.
std::ptrdiff_t lone_sides(const SideJoins& joins) { return std::count(joins.partner.begin(), joins.partner.end(), -1); }

// A side that is alone. Its ends are the lower and the higher one by labels.
struct LoneSide {
  std::array<int, 2> place;     // labels of the ends
  std::array<int, 2> vertices;  // at them
  int face;
  bool runs_up;  // from the lower one
};

// Those that could have a partner at one place, ordered by places. Labels keep faces back to back apart.
std::vector<LoneSide> by_places(const Polygons& mesh, const SideJoins& joins) {
  const std::vector<int> first = first_at_place(mesh.vertices, spacing(mesh));
  const std::vector<int> next = next_corners(mesh), face = corner_faces(mesh);
  std::vector<int> places;
  for (const int v : mesh.corner_vertices) places.push_back(first[v]);
  const std::vector<int> label = corner_labels(places, mesh.face_offsets).label;
  std::vector<LoneSide> found;
  for (int s = 0; s < static_cast<int>(next.size()); ++s) {
    if (joins.partner[s] >= 0) continue;
    const bool up = label[s] < label[next[s]];
    const int low = up ? s : next[s], high = up ? next[s] : s;
    found.push_back({{label[low], label[high]}, {mesh.corner_vertices[low], mesh.corner_vertices[high]}, face[s], up});
  }
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.place < b.place; });
  return found;
}

class Welder {
 public:
  Welder(const Polygons& mesh, Plan plan)
      : mesh_(mesh),
        plan_(std::move(plan)),
        lone_(lone_sides(plan_.joins)),
        sides_(by_places(mesh, plan_.joins)),
        is_barred_(mesh.vertices.size(), 0) {}

  Plan welded() && {
    const bool are_most = 2 * lone_ > std::ssize(mesh_.corner_vertices);
    const std::vector<char> was_crowded = is_crowded(plan_);
    for (;;) {
      const std::vector<int> vertices = joined_vertices(are_most);
      if (vertices == mesh_.corner_vertices) return std::move(plan_);
      Plan made = planned(mesh_, vertices);
      if (are_most) return 2 * lone_sides(made.joins) < lone_ ? std::move(made) : std::move(plan_);
      if (!bar(was_crowded, is_crowded(made))) return made;
    }
  }

 private:
  // #C. Where most sides are alone, those of any number of faces, in any direction: the plan finds out which continue
  // each other.
  std::vector<int> joined_vertices(bool any) {
    UnionFind vertices(mesh_.vertices.size());
    SignedSets sheets = plan_.joins.sheets;
    for (auto begin = sides_.begin(), end = begin; begin != sides_.end(); begin = end) {
      end = std::find_if(begin, sides_.end(), [&](const LoneSide& s) { return s.place != begin->place; });
      if (!any && !(end - begin == 2 && may_join(*begin, begin[1], sheets))) continue;
      for (auto s = begin; s != end; ++s) {
        for (int k = 0; k < 2; ++k) vertices.join(begin->vertices[k], s->vertices[k]);
      }
    }
    std::vector<int> result;
    for (const int v : mesh_.corner_vertices) result.push_back(vertices.lowest(v));
    return result;
  }

  // Joins their sheets, too: no part gets only one side.
  bool may_join(const LoneSide& s, const LoneSide& t, SignedSets& sheets) const {
    const auto barred = [this](int v) { return is_barred_[v] != 0; };
    const bool is_open = std::none_of(s.vertices.begin(), s.vertices.end(), barred) &&
                         std::none_of(t.vertices.begin(), t.vertices.end(), barred);
    if (!is_open || s.runs_up == t.runs_up || !sheets.allows(s.face, t.face, false)) return false;
    sheets.join(s.face, t.face, false);
    return true;
  }

  // #C whether a side is one of three or more.
  std::vector<char> is_crowded(const Plan& plan) const {
    std::vector<char> found(mesh_.corner_vertices.size(), 0);
    for (const auto& sides : plan.joins.many) {
      for (const int s : sides) found[s] = 1;
    }
    return found;
  }

  // Leaves vertices apart whose joining would make edges of three faces. Returns whether there are more of them.
  bool bar(const std::vector<char>& before, const std::vector<char>& now) {
    const std::vector<int> next = next_corners(mesh_);
    const auto count = std::count(is_barred_.begin(), is_barred_.end(), 1);
    for (std::size_t s = 0; s < now.size(); ++s) {
      if (now[s] != 0 && before[s] == 0)
        is_barred_[mesh_.corner_vertices[s]] = is_barred_[mesh_.corner_vertices[next[s]]] = 1;
    }
    return std::count(is_barred_.begin(), is_barred_.end(), 1) > count;
  }

  const Polygons& mesh_;
  Plan plan_;
  const std::ptrdiff_t lone_;
  const std::vector<LoneSide> sides_;
  std::vector<char> is_barred_;  // #V
};

template <class Index>
RepeatedCorners merged(BasicPolygons<Index>& mesh, std::vector<int>& face_index, std::vector<int>& corner_index) {
  RepeatedCorners found;
  std::vector<Index>& vertices = mesh.corner_vertices;
  std::size_t corners = 0, faces = 0;  // that are left, moved to the front
  Index begin = 0;
  for (std::size_t f = 0; f + 1 < mesh.face_offsets.size(); ++f) {
    const Index end = mesh.face_offsets[f + 1];
    const std::size_t first = corners, pairs = found.corners.size();
    for (Index c = begin; c != end; ++c) {
      if (end - begin >= 3 && vertices[c] == vertices[c == begin ? end - 1 : c - 1]) {
        found.corners.push_back({corner_index[c], corners > first ? corner_index[corners - 1] : -1});
        continue;
      }
      vertices[corners] = vertices[c];
      corner_index[corners++] = corner_index[c];
    }
    if (end - begin >= 3 && corners - first < 3) {
      found.faces.push_back(face_index[f]);
      found.corners.resize(pairs);
      corners = first;
    } else {
      for (std::size_t i = pairs; i < found.corners.size(); ++i) {
        if (found.corners[i][1] < 0) found.corners[i][1] = corner_index[corners - 1];
      }
      face_index[faces] = face_index[f];
      mesh.face_offsets[++faces] = static_cast<Index>(corners);
    }
    begin = end;
  }
  face_index.resize(faces);
  corner_index.resize(corners);
  vertices.resize(corners);
  mesh.face_offsets.resize(faces + 1);
  return found;
}

}  // namespace

double spacing(const Polygons& mesh) {
  const std::vector<int> next = next_corners(mesh);
  std::vector<double> sides(next.size());
  double largest = 0;
  for (std::size_t c = 0; c < next.size(); ++c) {
    const auto& point = mesh.vertices[mesh.corner_vertices[c]];
    sides[c] = largest_difference(point, mesh.vertices[mesh.corner_vertices[next[c]]]);
    largest = std::max(largest, largest_difference(point, {}));
  }
  const auto middle = sides.begin() + std::ssize(sides) / 2;
  std::nth_element(sides.begin(), middle, sides.end());
  const double found = std::max(kOfSide * *middle, kOfPlace * largest);
  return found > 0 ? std::ldexp(1.0, std::ilogb(found)) : 1.0;  // a power of two: division by it is exact
}

std::vector<int> without_point_sides(const Polygons& mesh) {
  const std::vector<int> next = next_corners(mesh);
  const auto length = [&](int c) {
    return largest_difference(mesh.vertices[mesh.corner_vertices[c]], mesh.vertices[mesh.corner_vertices[next[c]]]);
  };
  std::vector<Pair> sides;
  for (std::size_t f = 0; f + 1 < mesh.face_offsets.size(); ++f) {
    double longest = 0;
    for (int c = mesh.face_offsets[f]; c < mesh.face_offsets[f + 1]; ++c) longest = std::max(longest, length(c));
    for (int c = mesh.face_offsets[f]; c < mesh.face_offsets[f + 1]; ++c) {
      const int v = mesh.corner_vertices[c], w = mesh.corner_vertices[next[c]];
      if (v != w && length(c) <= std::max(longest / kWild, kOfPlace * largest_difference(mesh.vertices[v], {})))
        sides.push_back({std::min(v, w), std::max(v, w)});
    }
  }
  std::sort(sides.begin(), sides.end());
  UnionFind joined(mesh.vertices.size());
  for (auto begin = sides.begin(), end = begin; begin != sides.end(); begin = end) {
    end = std::upper_bound(begin, sides.end(), *begin);
    if (end - begin == 1) joined.join((*begin)[0], (*begin)[1]);
  }
  std::vector<int> result(mesh.vertices.size());
  for (int v = 0; v < static_cast<int>(result.size()); ++v) result[v] = joined.lowest(v);
  return result;
}

RepeatedCorners merge_repeated_corners(Polygons& mesh, std::vector<int>& face_index, std::vector<int>& corner_index) {
  return merged(mesh, face_index, corner_index);
}
RepeatedCorners merge_repeated_corners(GivenPolygons& mesh, std::vector<int>& face_index,
                                       std::vector<int>& corner_index) {
  return merged(mesh, face_index, corner_index);
}

std::vector<int> first_at_place(const std::vector<std::array<double, 3>>& vertices, double spacing) {
  struct Point {
    std::array<double, 3> place;
    int vertex;
    bool operator<(const Point& other) const { return std::tie(place, vertex) < std::tie(other.place, other.vertex); }
  };
  std::vector<Point> points(vertices.size());
  for (int v = 0; v < static_cast<int>(vertices.size()); ++v) {
    for (int k = 0; k < 3; ++k) points[v].place[k] = std::floor(vertices[v][k] / spacing + kShift);
    points[v].vertex = v;
  }
  std::sort(points.begin(), points.end());
  std::vector<int> first(vertices.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool is_same = i > 0 && points[i].place == points[i - 1].place;
    first[points[i].vertex] = is_same ? first[points[i - 1].vertex] : points[i].vertex;
  }
  return first;
}

bool meets_itself(const Surface& surface) {
  std::vector<char> is_open(surface.vertex_count, 0);
  for (std::size_t e = 0; e < surface.edges.size(); ++e) {
    if (surface.edge_face_count[e] == 1) is_open[surface.edges[e][0]] = is_open[surface.edges[e][1]] = 1;
  }
  std::vector<std::array<double, 3>> points;
  for (int v = 0; v < surface.vertex_count; ++v) {
    if (is_open[v] != 0) points.push_back(surface.polygons.vertices[v]);
  }
  if (points.empty()) return false;
  const std::vector<int> first = first_at_place(points, spacing(surface.polygons));
  return std::adjacent_find(first.begin(), first.end(), std::greater_equal<>()) != first.end();
}

Plan welded_plan(const Polygons& mesh) {
  Plan plan = planned(mesh, mesh.corner_vertices);
  return lone_sides(plan.joins) > 0 ? Welder(mesh, std::move(plan)).welded() : plan;
}

}  // namespace holomorph::mesh
