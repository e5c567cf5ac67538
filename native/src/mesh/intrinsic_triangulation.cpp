#include "mesh/intrinsic_triangulation.h"

#include <algorithm>
#include <utility>

#include "base/chunks.h"
#include "mesh/triangle_geometry.h"

namespace holomorph::mesh {
namespace {

// Slack that mollification leaves each triangle, relative to the mean length of the edges that it lengthens.
constexpr double kSlack = 1e-6;

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
    increment = kSlack * sum / static_cast<double>(edges_.size()) + lack;
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

}  // namespace holomorph::mesh
