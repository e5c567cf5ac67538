#include "mesh/facets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "mesh/cut_open.h"
#include "mesh/edge_faces.h"
#include "mesh/hard_edges.h"

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
  double bend = std::numeric_limits<double>::infinity();
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

}  // namespace holomorph::mesh
