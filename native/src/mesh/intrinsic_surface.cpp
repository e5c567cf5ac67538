#include "mesh/intrinsic_surface.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <unordered_map>
#include <utility>

#include "base/errors.h"
#include "base/workers.h"
#include "mesh/half_edges.h"
#include "mesh/orientation.h"
#include "mesh/triangle_geometry.h"

namespace holomorph::mesh {
namespace {

// Slack that mollification leaves each triangle, relative to the mean length of the edges that it lengthens.
constexpr double kLengthSlack = 1e-6;

double margin(double longest) { return std::max(kDegenerateMargin * longest, kLeastSlack); }

Triple edges_of(const IntrinsicTriangulation& t, int face) {
  const HalfedgeHandle h = t.half_edges.halfedge_handle(FaceHandle(face)), h1 = next(t.half_edges, h);
  return {edge_of(h), edge_of(h1), edge_of(next(t.half_edges, h1))};
}

std::array<double, 3> sides_of(const IntrinsicTriangulation& t, int face) {
  const auto [i, j, k] = edges_of(t, face);
  return {t.lengths[i], t.lengths[j], t.lengths[k]};
}

bool has_degenerate_face(const IntrinsicTriangulation& t, HalfedgeHandle h) {
  const HalfedgeHandle h1 = next(t.half_edges, h), h2 = next(t.half_edges, h1);
  return is_degenerate(t.lengths[edge_of(h)], t.lengths[edge_of(h1)], t.lengths[edge_of(h2)]);
}

// All cotangents, in the order of the edges, which is that of the vertices: near each other in memory wherever
// neighbours are, in whatever order the faces come. @return whether a triangle is degenerate
bool set_all_cotangents(IntrinsicTriangulation& t, Workers& workers) {
  t.cotangents.resize(t.half_edges.n_halfedges());
  const int count = sum_over_rows(workers, static_cast<int>(t.cotangents.size()), 0, [&t](int i, int& sum) {
    const HalfedgeHandle h(i);
    if (t.half_edges.is_boundary(h)) {
      t.cotangents[i] = 0;
    } else if (is_first_of_face(t.half_edges, h)) {
      set_cotangents(t, h);
      sum += has_degenerate_face(t, h);
    }
  });
  return count > 0;
}

// The faces for which chosen(shortest side, longest side, slack) holds.
template <class Chosen>
std::vector<int> chosen_faces(const IntrinsicTriangulation& t, const Chosen& chosen) {
  std::vector<int> faces;
  for (int f = 0; f < static_cast<int>(t.half_edges.n_faces()); ++f) {
    const auto [a, b, c] = sides_of(t, f);
    const double longest = std::max({a, b, c});
    if (chosen(std::min({a, b, c}), longest, (a + b + c) - 2 * longest)) faces.push_back(f);
  }
  return faces;
}

// Edges that are to grow by one increment.
class Growth {
 public:
  explicit Growth(IntrinsicTriangulation& t) : t_(t), grows_(t.lengths.size(), 0) {}

  void add(int face) {
    for (const int e : edges_of(t_, face)) {
      if (!std::exchange(grows_[e], 1)) edges_.push_back(e);
    }
  }

  // The slack that is to be left, and what the faces lack of it.
  void choose_increment(const std::vector<int>& faces) {
    double sum = 0, lack = 0;
    for (const int e : edges_) sum += t_.lengths[e];
    for (const int f : faces) {
      const auto [a, b, c] = sides_of(t_, f);
      lack = std::max(lack, 2 * std::max({a, b, c}) - (a + b + c));
    }
    increment = kLengthSlack * sum / static_cast<double>(edges_.size()) + lack;
  }

  // Faces at these edges that become degenerate grow altogether, and so on: in the end those of a connected surface do.
  void spread() {
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      for (const int side : {0, 1}) {
        const FaceHandle f = t_.half_edges.face_handle(HalfedgeHandle(2 * edges_[i] + side));
        if (f.is_valid() && becomes_degenerate(f.idx())) add(f.idx());
      }
    }
  }

  void apply() {
    for (const int e : edges_) t_.lengths[e] += increment;
  }

  double increment = 0;

 private:
  bool becomes_degenerate(int face) const {
    double side[3];
    int i = 0;
    for (const int e : edges_of(t_, face)) side[i++] = t_.lengths[e] + (grows_[e] ? increment : 0.0);
    return is_degenerate(side[0], side[1], side[2]);
  }

  IntrinsicTriangulation& t_;
  std::vector<char> grows_;
  std::vector<int> edges_;
};

// @return whether there was something to lengthen
template <class Chosen>
bool lengthen(IntrinsicTriangulation& t, const Chosen& chosen, Workers& workers) {
  const std::vector<int> faces = chosen_faces(t, chosen);
  if (faces.empty()) return false;
  Growth growth(t);
  for (const int f : faces) growth.add(f);
  growth.choose_increment(faces);
  growth.spread();
  growth.apply();
  t.mollification = std::max(t.mollification, growth.increment);
  // The lengthened edges are another metric: errors against the given one mean nothing any more.
  t.metric_errors = Array<FaceError>();
  set_all_cotangents(t, workers);
  return true;
}

IntrinsicTriangulation without_errors(const Surface& surface, HalfEdges half_edges, Workers& workers) {
  IntrinsicTriangulation result;
  result.half_edges = std::move(half_edges);
  result.lengths.resize(surface.edge_lengths.size());
  for_rows(workers, static_cast<int>(result.lengths.size()),
           [&](int e) { result.lengths[e] = surface.edge_lengths[e]; });
  result.degenerate = set_all_cotangents(result, workers);
  return result;
}

using std::to_string;
using Indices = std::vector<std::array<std::int64_t, 3>>;

// Two triangles may give the length of their common edge with this relative difference: rounding of the caller's.
constexpr double kLengthAgreement = 1e-9;

void check_face(std::size_t f, int vertex_count, const std::array<std::int64_t, 3>& vertices,
                const std::array<double, 3>& lengths, bool has_edge_names) {
  const std::string face = "face " + to_string(f);
  for (int i = 0; i < 3; ++i) {
    const std::int64_t v = vertices[i];
    if (v < 0) throw InvalidMesh(face + " has the negative vertex index " + to_string(v));
    if (v >= vertex_count) {
      throw InvalidMesh(face + " names vertex " + to_string(v) + "; numbers from 0 to below " +
                        to_string(vertex_count) + " are needed");
    }
    if (!std::isfinite(lengths[i]) || lengths[i] < 0)
      throw InvalidMesh(face + " has an edge length that is negative or not finite");
    if (lengths[i] > kLargest) throw InvalidMesh(face + " has an edge length beyond 1e60: scale the lengths down");
    if (!has_edge_names && v == vertices[(i + 1) % 3])
      throw InvalidMesh(face + " has vertex " + to_string(v) + " twice; name its edges with face_edges");
  }
}

void check_input(int vertex_count, const Indices& faces, const std::vector<std::array<double, 3>>& lengths,
                 const Indices& face_edges) {
  if (faces.empty()) throw InvalidMesh("the mesh has no faces");
  if (lengths.size() != faces.size()) {
    throw InvalidMesh("edge_lengths has " + to_string(lengths.size()) + " rows for " + to_string(faces.size()) +
                      " faces");
  }
  if (!face_edges.empty() && face_edges.size() != faces.size()) {
    throw InvalidMesh("face_edges has " + to_string(face_edges.size()) + " rows for " + to_string(faces.size()) +
                      " faces");
  }
  double longest = 0;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    check_face(f, vertex_count, faces[f], lengths[f], !face_edges.empty());
    longest = std::max({longest, lengths[f][0], lengths[f][1], lengths[f][2]});
  }
  if (longest > 0 && longest < kSmallest) throw InvalidMesh("all edge lengths are below 1e-60: scale them up");
}

struct Side {
  std::int64_t key[2];  // name of the edge, or its ends, lower first
  int triangle, side;
};

// The sides in the order of their keys, so that the sides of an edge are neighbours.
std::vector<Side> sorted_sides(const Indices& faces, const Indices& face_edges) {
  std::vector<Side> sides;
  sides.reserve(3 * faces.size());
  for (int t = 0; t < static_cast<int>(faces.size()); ++t) {
    for (int i = 0; i < 3; ++i) {
      const std::int64_t a = faces[t][i], b = faces[t][(i + 1) % 3];
      // side i lies opposite corner i + 2
      if (face_edges.empty()) {
        sides.push_back({{std::min(a, b), std::max(a, b)}, t, i});
      } else {
        sides.push_back({{face_edges[t][(i + 2) % 3], 0}, t, i});
      }
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& x, const Side& y) {
    return std::tie(x.key[0], x.key[1], x.triangle, x.side) < std::tie(y.key[0], y.key[1], y.triangle, y.side);
  });
  return sides;
}

bool same_edge(const Side& x, const Side& y) { return x.key[0] == y.key[0] && x.key[1] == y.key[1]; }

class EdgeBuilder {
 public:
  EdgeBuilder(Surface& surface, const std::vector<std::array<double, 3>>& lengths)
      : surface_(surface), lengths_(lengths) {}

  // Adds the edge whose sides are begin .. end-1.
  void add(const Side* begin, const Side* end) {
    const int edge = static_cast<int>(surface_.edges.size());
    const Pair ends = ends_of(*begin);
    const std::string name =
        "edge " + to_string(edge) + " (vertices " + to_string(ends[0]) + ", " + to_string(ends[1]) + ")";
    if (end - begin > 2) throw InvalidMesh(name + " has " + to_string(end - begin) + " faces; a surface has at most 2");
    for (const Side* s = begin; s != end; ++s) {
      if (ends_of(*s) != ends) throw InvalidMesh(name + " has different ends in face " + to_string(s->triangle));
      if (std::abs(length(*s) - length(*begin)) > kLengthAgreement * length(*begin)) {
        throw InvalidMesh(name + " has two lengths, in faces " + to_string(begin->triangle) + " and " +
                          to_string(s->triangle));
      }
      surface_.triangle_edges[s->triangle][s->side] = edge;
    }
    surface_.edges.push_back(ends);
    surface_.edge_lengths.push_back(length(*begin));
    surface_.edge_face_count.push_back(static_cast<char>(end - begin));
    if (end - begin == 2) meetings.push_back(meeting(edge, begin[0], begin[1]));
  }

  std::vector<EdgeMeeting> meetings;

 private:
  Pair ends_of(const Side& s) const {
    const int a = surface_.triangles[s.triangle][s.side], b = surface_.triangles[s.triangle][(s.side + 1) % 3];
    return {std::min(a, b), std::max(a, b)};
  }
  double length(const Side& s) const { return lengths_[s.triangle][(s.side + 2) % 3]; }
  // The two sides of a loop say nothing about direction: they are taken to be glued as an oriented surface glues them.
  EdgeMeeting meeting(int edge, const Side& x, const Side& y) const {
    const int a = surface_.triangles[x.triangle][x.side], b = surface_.triangles[y.triangle][y.side];
    const Pair ends = ends_of(x);
    return {edge, x.triangle, y.triangle, a == b && ends[0] != ends[1]};
  }

  Surface& surface_;
  const std::vector<std::array<double, 3>>& lengths_;
};

// Reading a triangle in reverse keeps its corner 0: corners 1 and 2 change places, and sides 0 and 2.
void reverse_triangles(Surface& surface) {
  for (const int t : surface.repairs.reversed_faces) {
    std::swap(surface.triangles[t][1], surface.triangles[t][2]);
    std::swap(surface.triangle_corners[t][1], surface.triangle_corners[t][2]);
    std::swap(surface.triangle_edges[t][0], surface.triangle_edges[t][2]);
  }
}

}  // namespace

void set_cotangents(IntrinsicTriangulation& t, HalfedgeHandle h) {
  const HalfedgeHandle h1 = next(t.half_edges, h), h2 = next(t.half_edges, h1);
  const double a = t.lengths[edge_of(h)], b = t.lengths[edge_of(h1)], c = t.lengths[edge_of(h2)];
  const double area = triangle_area(a, b, c);
  const double x = cotangent(a, b, c, area), y = cotangent(b, c, a, area), z = cotangent(c, a, b, area);
  t.cotangents[h.idx()] = x;
  t.cotangents[h1.idx()] = y;
  t.cotangents[h2.idx()] = z;
}

IntrinsicTriangulation given_triangulation(const Surface& surface, HalfEdges half_edges, Workers& workers) {
  IntrinsicTriangulation result = without_errors(surface, std::move(half_edges), workers);
  result.metric_errors = metric_errors(result.metric(), surface, workers);
  return result;
}

bool mollify(IntrinsicTriangulation& t, Workers& workers) {
  t.degenerate = false;
  return lengthen(
      t, [](double, double longest, double slack) { return !(slack > margin(longest)); }, workers);
}

void mollify_needles(IntrinsicTriangulation& t, Workers& workers) {
  lengthen(
      t, [](double shortest, double longest, double) { return !(shortest > margin(longest)); }, workers);
}

IntrinsicTriangulation intrinsic_triangulation(const Surface& surface, HalfEdges half_edges, Workers& workers) {
  IntrinsicTriangulation result = without_errors(surface, std::move(half_edges), workers);
  if (result.degenerate) mollify(result, workers);
  return result;
}

double mollification(const Surface& surface, Execution& execution) {
  if (surface.repairs.zero_area_faces.empty()) return 0;
  return intrinsic_triangulation(surface, half_edges(surface, execution), execution.workers()).mollification;
}

Array<double> cotangent_weights(const IntrinsicTriangulation& t, Execution& execution) {
  Array<double> weights;
  weights.reserve(t.lengths.size());
  advise_large_pages(weights.data(), t.lengths.size() * sizeof(double));
  weights.resize(t.lengths.size());
  for_rows(execution.workers(), static_cast<int>(weights.size()),
           [&](int e) { weights[e] = 0.5 * t.cotangents[2 * e] + 0.5 * t.cotangents[2 * e + 1]; });
  if (t.mollification == 0) sharpen_weights(t.metric(), weights, execution.workers());
  execution.report(1.0);
  return weights;
}

Surface make_intrinsic_surface(int vertex_count, const Indices& faces,
                               const std::vector<std::array<double, 3>>& lengths, const Indices& face_edges,
                               Execution& execution) {
  check_input(vertex_count, faces, lengths, face_edges);
  Surface surface;
  surface.vertex_count = vertex_count;
  surface.polygons.face_offsets.push_back(0);
  for (int t = 0; t < static_cast<int>(faces.size()); ++t) {
    Triple v, corners{3 * t, 3 * t + 1, 3 * t + 2};
    for (int i = 0; i < 3; ++i) v[i] = static_cast<int>(faces[t][i]);
    surface.triangles.push_back(v);
    surface.triangle_corners.push_back(corners);
    surface.triangle_faces.push_back(t);
    surface.polygons.corner_vertices.insert(surface.polygons.corner_vertices.end(), faces[t].begin(), faces[t].end());
    surface.polygons.face_offsets.push_back(3 * t + 3);
  }
  surface.triangle_edges.resize(faces.size());
  const std::vector<Side> sides = sorted_sides(faces, face_edges);
  EdgeBuilder builder(surface, lengths);
  for (std::size_t i = 0, j; i < sides.size(); i = j) {
    for (j = i + 1; j < sides.size() && same_edge(sides[i], sides[j]);) ++j;
    builder.add(&sides[i], &sides[i] + (j - i));
  }
  surface.polygon_edge_count = static_cast<int>(surface.edges.size());
  record_orientation(surface, orient(static_cast<int>(faces.size()), builder.meetings));
  reverse_triangles(surface);
  finish_records(surface, execution);
  return surface;
}

}  // namespace holomorph::mesh
