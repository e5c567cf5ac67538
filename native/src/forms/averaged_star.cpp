#include "forms/averaged_star.h"

namespace holomorph::forms {

using mesh::edge_of;
using mesh::HalfedgeHandle;
using mesh::next;
using mesh::opposite;
using mesh::sign;

std::vector<double> averaged_star(const mesh::IntrinsicTriangulation& triangulation, const std::vector<double>& form) {
  const mesh::HalfEdges& half_edges = triangulation.half_edges;
  std::vector<double> star(form.size(), 0.0);
  for (int f = 0; f < static_cast<int>(half_edges.n_faces()); ++f) {
    HalfedgeHandle h = half_edges.halfedge_handle(mesh::FaceHandle(f));
    for (int i = 0; i < 3; ++i, h = next(half_edges, h)) {
      // Side h opposite corner 0, corners 1 and 2 its ends: (*w)(h) = cot_2 w(0 -> 1) + cot_1 w(0 -> 2), the flux
      // through h.
      const HalfedgeHandle to_apex = next(half_edges, h), from_apex = next(half_edges, to_apex);
      const double at_start = triangulation.cotangents[to_apex.idx()];
      const double at_end = triangulation.cotangents[from_apex.idx()];
      const double to_start = sign(from_apex) * form[edge_of(from_apex)],
                   to_end = -sign(to_apex) * form[edge_of(to_apex)];
      // A face of an edge has half a vote, the only face of a boundary edge a whole one.
      const double share = half_edges.is_boundary(opposite(h)) ? 1.0 : 0.5;
      star[edge_of(h)] += share * sign(h) * (at_end * to_start + at_start * to_end);
    }
  }
  return star;
}

}  // namespace holomorph::forms
