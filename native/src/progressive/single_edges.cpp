#include "progressive/single_edges.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <set>
#include <string>

#include "base/errors.h"

namespace holomorph::progressive {
namespace {

using mesh::Pair;
using mesh::Surface;
using mesh::Triple;

// Diagonals with the same ends as an edge before them, ascending.
std::vector<int> doubled_diagonals(const Surface& surface) {
  std::vector<int> order(surface.edges.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return surface.edges[a] != surface.edges[b] ? surface.edges[a] < surface.edges[b] : a < b;
  });
  std::vector<int> doubled;  // edges of polygons come before diagonals, and no two of them have the same ends
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (surface.edges[order[i]] == surface.edges[order[i - 1]]) doubled.push_back(order[i]);
  }
  std::sort(doubled.begin(), doubled.end());
  return doubled;
}

struct Place {
  int triangle = -1, side = 0;
};

// The two places of a diagonal, among the triangles of its polygon; these are consecutive.
std::array<Place, 2> places_of(const Surface& surface, int e, int polygon) {
  const auto [begin, end] = std::equal_range(surface.triangle_faces.begin(), surface.triangle_faces.end(), polygon);
  std::array<Place, 2> places;
  int found = 0;
  for (auto f = begin; f != end; ++f) {
    const int t = static_cast<int>(f - surface.triangle_faces.begin());
    for (int i = 0; i < 3 && found < 2; ++i) {
      if (surface.triangle_edges[t][i] == e) places[found++] = {t, i};
    }
  }
  return places;
}

// Flips edge e of the triangles p q r and q p w: they become p w r and w q r.
void flip(Surface& surface, int e, Place a, Place b) {
  const auto rotated = [](const Triple& t, int side) { return Triple{t[side], t[(side + 1) % 3], t[(side + 2) % 3]}; };
  for (auto* rows : {&surface.triangles, &surface.triangle_corners}) {
    const auto [p, q, r] = rotated((*rows)[a.triangle], a.side);
    const int w = (*rows)[b.triangle][(b.side + 2) % 3];
    (*rows)[a.triangle] = {p, w, r};
    (*rows)[b.triangle] = {w, q, r};
  }
  const auto [along, qr, rp] = rotated(surface.triangle_edges[a.triangle], a.side);
  const auto [back, pw, wq] = rotated(surface.triangle_edges[b.triangle], b.side);
  surface.triangle_edges[a.triangle] = {pw, e, rp};
  surface.triangle_edges[b.triangle] = {wq, qr, e};
}

}  // namespace

std::optional<Surface> with_single_edges(const Surface& surface) {
  if (surface.intrinsic()) throw InvalidMesh("a progressive mesh needs positions; this surface has edge lengths only");
  if (!surface.has_diagonals()) return {};
  const std::vector<int> doubled = doubled_diagonals(surface);
  if (doubled.empty()) return {};
  std::vector<int> polygon(surface.edges.size());
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    for (const int e : surface.triangle_edges[t]) polygon[e] = surface.triangle_faces[t];
  }
  Surface result = surface;
  std::set<Pair> ends(surface.edges.begin(), surface.edges.end());
  for (const int e : doubled) {
    const auto places = places_of(result, e, polygon[e]);
    const auto apex = [&](const Place& p) { return result.triangles[p.triangle][(p.side + 2) % 3]; };
    const int a = apex(places[0]), b = apex(places[1]);
    const Pair flipped{std::min(a, b), std::max(a, b)};
    // The new edge must not double another one, nor one made by an earlier flip.
    if (a == b || !ends.insert(flipped).second) {
      throw InvalidMesh("the triangulated polygons have two edges between vertices " +
                        std::to_string(result.edges[e][0]) + " and " + std::to_string(result.edges[e][1]) +
                        "; subdivide them for a progressive mesh");
    }
    flip(result, e, places[0], places[1]);
    result.edges[e] = flipped;
  }
  return result;
}

}  // namespace holomorph::progressive
