#include "mesh/hard_edges.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/constants.h"
#include "mesh/cut_open.h"
#include "mesh/triangle_geometry.h"
#include "mesh/union_find.h"

namespace holomorph::mesh {
namespace {

constexpr double kFlat = radians(10);  // faces that bend less are of one place
// Width of a place over the root of the area, from which on it is a facet, and no strip between facets.
constexpr double kWide = 0.06;
constexpr double kLevel = 0.97;  // length of the sum of normals over the area, from which on a place is flat as a whole
// Times as wide as a strip beside it a facet is at least; faces of a coarse smooth mesh are alike.
constexpr double kNarrow = 2.5;
// Strips go to the facet to which they bend least, in these steps.
constexpr std::array<double, 4> kSteps{radians(15), radians(30), radians(45), radians(60)};

struct Place {
  std::array<double, 3> normal{};  // as long as the area where the place is flat
  double area = 0, around = 0;     // around: length of its borders to others

  double width() const { return around > 0 ? 2 * area / around : 0; }
};

// An edge between two places.
struct Border {
  int edge, one, other;
};

std::vector<Place> places_of(const Surface& surface, const std::vector<int>& place,
                             const std::vector<Border>& borders) {
  std::vector<Place> result(1 + *std::ranges::max_element(place));
  const auto normals = triangle_normals(surface);
  for (std::size_t t = 0; t < normals.size(); ++t) {
    Place& own = result[place[surface.triangle_faces[t]]];
    const auto& [x, y, z] = normals[t];
    for (int i = 0; i < 3; ++i) own.normal[i] += normals[t][i] / 2;
    own.area += std::sqrt(x * x + y * y + z * z) / 2;
  }
  for (const Border& border : borders) result[border.one].around += surface.edge_lengths[border.edge];
  for (const Border& border : borders) result[border.other].around += surface.edge_lengths[border.edge];
  return result;
}

// Whether it is wide and flat.
bool is_facet(const Place& place, double whole_area) {
  const auto& [x, y, z] = place.normal;
  return place.width() >= kWide * std::sqrt(whole_area) && std::sqrt(x * x + y * y + z * z) >= kLevel * place.area;
}

// What a strip may be part of, by how little it bends to it; of equals the lowest facet.
struct Choice {
  double bend = kInfinity;
  int facet = -1;

  bool operator<(const Choice& other) const { return bend < other.bend || (bend == other.bend && facet < other.facet); }
};

// Gives strips, where `facet` is -1, the facet of a neighbour.
void add_strips(const std::vector<Border>& borders, const std::vector<Place>& places, const std::vector<double>& bend,
                std::vector<int>& facet) {
  for (const double most : kSteps) {
    for (bool goes_on = true; goes_on;) {
      std::vector<Choice> best(facet.size());
      const auto consider = [&](int strip, int beside, double bent) {
        if (facet[strip] >= 0 || facet[beside] < 0 || !(bent <= most)) return;
        if (kNarrow * places[strip].width() <= places[facet[beside]].width())
          best[strip] = std::min(best[strip], Choice{bent, facet[beside]});
      };
      for (const auto& [edge, one, other] : borders) {
        consider(one, other, bend[edge]);
        consider(other, one, bend[edge]);
      }
      goes_on = false;
      for (std::size_t k = 0; k < facet.size(); ++k) {
        if (best[k].facet >= 0) facet[k] = best[k].facet, goes_on = true;
      }
    }
  }
}

// Radians, from which on a bend hides a seam; where it is less, in proportion.
constexpr double kHiding = std::numbers::pi / 3;

Point normal_of(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// Sums what is missing around vertices that edges without length join, at the lowest of them.
void join_places(const Surface& surface, std::vector<double>& defects) {
  UnionFind places(defects.size());
  for (std::size_t e = 0; e < surface.edges.size(); ++e) {
    if (surface.edge_lengths[e] == 0) places.join(surface.edges[e][0], surface.edges[e][1]);
  }
  for (int v = 0; v < std::ssize(defects); ++v) {
    const int lowest = places.lowest(v);
    if (lowest == v) continue;
    defects[lowest] += defects[v];
    defects[v] = 0;
  }
}

// 2 pi less the angles at each vertex, #V.
std::vector<double> angle_defects(const Surface& surface) {
  std::vector<double> sums(surface.vertex_count, 0.0);
  bool has_points = false;
  for (const Triple& triangle : surface.triangles) {
    std::array<Point, 3> sides;
    std::array<bool, 3> is_point{};
    for (int i = 0; i < 3; ++i) {
      sides[i] = difference(surface.polygons.vertices[triangle[(i + 1) % 3]], surface.polygons.vertices[triangle[i]]);
      is_point[i] = sides[i] == Point{};
      has_points = has_points || is_point[i];
    }
    for (int i = 0; i < 3; ++i) {
      const Point& back = sides[(i + 2) % 3];
      double angle = angle_between(sides[i], {-back[0], -back[1], -back[2]});
      // A side without length, at whose ends the angles are a right one each in the limit.
      if (is_point[i] || is_point[(i + 2) % 3]) angle += std::numbers::pi / 2;
      sums[triangle[i]] += angle;
    }
  }
  for (double& sum : sums) sum = kTwoPi - sum;
  if (has_points) join_places(surface, sums);
  return sums;
}

}  // namespace

std::vector<double> breaks(const Surface& surface) {
  std::vector<double> result = bends(surface);
  std::vector<char> is_cut(result.size());
  std::ranges::transform(result, is_cut.begin(), [](double bend) { return bend > kFlat ? 1 : 0; });
  const std::vector<int> place = parts(surface, is_cut);
  std::vector<Border> borders;
  const std::vector<Pair> faces = edge_faces(surface);
  for (int e = 0; e < std::ssize(faces); ++e) {
    const auto [one, other] = faces[e];
    if (other >= 0 && place[one] != place[other]) borders.push_back({e, place[one], place[other]});
  }
  if (borders.empty()) return result;
  const std::vector<Place> places = places_of(surface, place, borders);
  double whole_area = 0;
  for (const Place& one : places) whole_area += one.area;
  std::vector<int> facet(places.size());
  for (int k = 0; k < std::ssize(places); ++k) facet[k] = is_facet(places[k], whole_area) ? k : -1;
  add_strips(borders, places, result, facet);
  for (const auto& [edge, a, b] : borders) {
    const int one = facet[a], other = facet[b];
    if (one == other || one < 0 || other < 0) continue;
    result[edge] = std::max(result[edge], angle_between(places[one].normal, places[other].normal));
  }
  return result;
}

double angle_between(const Point& a, const Point& b) {
  const Point normal = normal_of(a, b);
  // A product may be -0 where a vector is 0; the angle is 0 then.
  return std::atan2(std::sqrt(dot(normal, normal)), 0.0 + dot(a, b));
}

std::vector<Point> triangle_normals(const Surface& surface) {
  std::vector<Point> result(surface.triangles.size());
  const auto& points = surface.polygons.vertices;
  for (std::size_t t = 0; t < result.size(); ++t) {
    const auto& [a, b, c] = surface.triangles[t];
    result[t] = normal_of(difference(points[b], points[a]), difference(points[c], points[a]));
  }
  return result;
}

std::vector<Point> face_normals(const Surface& surface) {
  std::vector<Point> sums(surface.face_component.size(), Point{});
  const auto normals = triangle_normals(surface);
  for (std::size_t t = 0; t < normals.size(); ++t) {
    for (int i = 0; i < 3; ++i) sums[surface.triangle_faces[t]][i] += normals[t][i];
  }
  for (Point& normal : sums) {
    const double size = std::sqrt(dot(normal, normal));
    for (double& x : normal) x = size > 0 ? x / size : 0;
  }
  const std::vector<int> owners = sliver_owners(surface);
  std::vector<Point> result(sums.size());
  for (std::size_t f = 0; f < sums.size(); ++f) result[f] = sums[owners[f]];
  return result;
}

std::vector<double> bends(const Surface& surface) {
  const std::vector<Point> normals = face_normals(surface);
  std::vector<double> result(surface.edges.size(), 0.0);
  const std::vector<Pair> faces = edge_faces(surface);
  for (std::size_t e = 0; e < faces.size(); ++e) {
    if (faces[e][1] >= 0) result[e] = angle_between(normals[faces[e][0]], normals[faces[e][1]]);
  }
  return result;
}

double seen(double breaks_off) { return std::max(1 - breaks_off / kHiding, 0.0); }

std::vector<char> cuts_to_tips(const Surface& surface, const std::vector<char>& is_seam, Execution& execution) {
  const std::vector<char> is_border = on_border(surface, is_seam);
  const std::vector<double> defects = angle_defects(surface);
  std::vector<char> tips(surface.vertex_count);
  for (int v = 0; v < surface.vertex_count; ++v) tips[v] = std::abs(defects[v]) > kTip && !is_border[v] ? 1 : 0;
  return paths_to_border(surface, is_border, tips, execution);
}

double curvature(const Surface& surface, const std::vector<char>& is_seam, double most) {
  const std::vector<char> is_border = on_border(surface, is_seam);
  const std::vector<double> defects = angle_defects(surface);
  double sum = 0;
  for (int v = 0; v < surface.vertex_count; ++v) {
    const double missing = std::abs(defects[v]);
    if (!is_border[v] && missing <= most) sum += missing;
  }
  return sum;
}

}  // namespace holomorph::mesh
