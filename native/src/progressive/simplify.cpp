#include "progressive/simplify.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <set>
#include <string>

#include "base/errors.h"
#include "mesh/make_surface.h"
#include "mesh/triangle_geometry.h"
#include "progressive/collapse_orders.h"

namespace holomorph::progressive {
namespace {

using Faces = std::vector<Triple>;
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

// Numbers vertices and triangles: those of the base first, then what each split brings.
class Recorder {
 public:
  Recorder(const mesh::Surface& surface, const std::vector<Collapse>& collapses, std::size_t count)
      : surface_(surface), collapses_(collapses.begin(), collapses.begin() + static_cast<std::ptrdiff_t>(count)) {
    number_base();
    number_splits();
  }

  bool base_has_area() const {
    const Faces faces = base_faces();
    const auto at = [&](int v) { return surface_.polygons.vertices[vertices_[v]]; };
    return std::any_of(faces.begin(), faces.end(), [&](const Triple& t) {
      return !mesh::is_degenerate(mesh::distance(at(t[0]), at(t[1])), mesh::distance(at(t[1]), at(t[2])),
                                  mesh::distance(at(t[2]), at(t[0])));
    });
  }

  ProgressiveMesh record(Execution& execution) const {
    ProgressiveMesh mesh;
    mesh.vertex_index = vertices_;
    mesh.triangle_index = triangles_;
    for (const int v : vertices_) mesh.positions.push_back(surface_.polygons.vertices[v]);
    mesh.splits.reserve(collapses_.size());
    for (auto c = collapses_.rbegin(); c != collapses_.rend(); ++c) {
      const auto at = [this](int v) { return v < 0 ? -1 : new_vertex_[v]; };
      const auto slot = [](int side) { return static_cast<std::uint8_t>(side < 0 ? 0 : side & 3); };
      mesh.splits.push_back({at(c->v_s), at(c->v_l), at(c->v_r), slot(c->left), slot(c->right)});
    }
    mesh.base = make_surface(
        triangle_polygons({mesh.positions.begin(), mesh.positions.begin() + base_vertices_}, base_faces()), execution);
    record_polygons(mesh);
    return mesh;
  }

 private:
  void number_base() {
    std::vector<char> removed(surface_.vertex_count, 0), triangle_removed(surface_.triangles.size(), 0);
    for (const int v : surface_.repairs.isolated_vertices) removed[v] = 1;
    for (const Collapse& c : collapses_) {
      removed[c.v_t] = 1;
      for (const int side : {c.left, c.right}) {
        if (side >= 0) triangle_removed[side / 4] = 1;
      }
    }
    for (int v = 0; v < surface_.vertex_count; ++v) {
      if (!removed[v]) vertices_.push_back(v);
    }
    for (int t = 0; t < static_cast<int>(surface_.triangles.size()); ++t) {
      if (!triangle_removed[t]) triangles_.push_back(t);
    }
    base_vertices_ = static_cast<std::ptrdiff_t>(vertices_.size());
    base_triangles_ = triangles_.size();
  }

  void number_splits() {
    // Splits undo the collapses in reverse order; each brings its vertex, then its left and its right triangle.
    for (auto c = collapses_.rbegin(); c != collapses_.rend(); ++c) {
      vertices_.push_back(c->v_t);
      for (const int side : {c->left, c->right}) {
        if (side >= 0) triangles_.push_back(side / 4);
      }
    }
    // Isolated vertices come last: no level has them, but the original is restored with them.
    for (const int v : surface_.repairs.isolated_vertices) vertices_.push_back(v);
    new_vertex_.resize(vertices_.size());
    for (std::size_t i = 0; i < vertices_.size(); ++i) new_vertex_[vertices_[i]] = static_cast<int>(i);
  }

  // The triangles of the base, every vertex replaced by the one it was collapsed into.
  Faces base_faces() const {
    std::vector<int> root(vertices_.size());
    std::iota(root.begin(), root.end(), 0);
    // From the last collapse to the first: the root of v_s is then known.
    for (auto c = collapses_.rbegin(); c != collapses_.rend(); ++c)
      root[new_vertex_[c->v_t]] = root[new_vertex_[c->v_s]];
    Faces faces;
    for (std::size_t i = 0; i < base_triangles_; ++i) {
      Triple t = surface_.triangles[triangles_[i]];
      for (int& v : t) v = root[new_vertex_[v]];
      faces.push_back(t);
    }
    return faces;
  }

  void record_polygons(ProgressiveMesh& mesh) const {
    const auto& offsets = surface_.polygons.face_offsets;
    if (offsets.size() != surface_.triangles.size() + 1) mesh.face_offsets.assign(offsets.begin(), offsets.end());
    if (!mesh.face_offsets.empty() || !surface_.repairs.reversed_faces.empty()) {
      for (const int t : triangles_) mesh.triangle_corners.push_back(surface_.triangle_corners[t]);
    }
  }

  const mesh::Surface& surface_;
  std::vector<Collapse> collapses_;
  std::vector<int> vertices_, triangles_, new_vertex_;
  std::ptrdiff_t base_vertices_ = 0;
  std::size_t base_triangles_ = 0;
};

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

ProgressiveMesh progressive_mesh(const mesh::Surface& given, Order order, Execution& execution,
                                 const std::vector<int>& kept) {
  execution.stage("edge collapses", 0.0, 1.0);
  const auto flipped = with_single_edges(given);
  const mesh::Surface& surface = flipped ? *flipped : given;
  EdgeCollapse collapse(surface);
  for (const int v : kept) collapse.vertex(v).flags |= Vertex::kKept;
  order == Order::quadric ? collapse_by_quadrics(collapse, execution) : collapse_independent_sets(collapse, execution);
  execution.finish();
  Execution silent(execution.threads());
  const std::size_t count = collapse.collapses().size();
  // Leaves out the last 0, 1, 3, 7 ... collapses, until a triangle of the base has an area: a surface needs one. It
  // ends with the original, which has.
  for (std::size_t left_out = 0;; left_out = 2 * left_out + 1) {
    const Recorder recorder(surface, collapse.collapses(), count - std::min(count, left_out));
    if (recorder.base_has_area()) return recorder.record(silent);
  }
}

}  // namespace holomorph::progressive
