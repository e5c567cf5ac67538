#include "topology/homology.h"

#include <algorithm>

namespace holomorph::topology {
namespace {

using mesh::edge_of;
using mesh::face_of;
using mesh::from_vertex;
using mesh::next;
using mesh::opposite;
using mesh::sign;
using mesh::to_vertex;

void add_crossing(HalfedgeHandle leaving, int form, int direction, IntegerForms& forms) {
  forms.rows[edge_of(leaving)].emplace_back(form, direction * sign(leaving));
}

}  // namespace

std::vector<std::vector<HalfedgeHandle>> homology_basis(const HalfEdges& mesh, const FundamentalDomain& domain) {
  std::vector<std::vector<HalfedgeHandle>> loops;
  for (const int e : domain.left_over) {
    const HalfedgeHandle h(2 * e);
    int a = from_vertex(mesh, h), b = to_vertex(mesh, h);
    std::vector<HalfedgeHandle> from_b, towards_a;  // e, then b up to the common vertex, then down to a
    while (a != b) {
      if (domain.vertex_depth[b] >= domain.vertex_depth[a]) {
        from_b.push_back(domain.to_parent_vertex[b]);
        b = to_vertex(mesh, from_b.back());
      } else {
        towards_a.push_back(opposite(domain.to_parent_vertex[a]));
        a = from_vertex(mesh, towards_a.back());
      }
    }
    std::vector<HalfedgeHandle> loop{h};
    loop.insert(loop.end(), from_b.begin(), from_b.end());
    loop.insert(loop.end(), towards_a.rbegin(), towards_a.rend());
    loops.push_back(std::move(loop));
  }
  return loops;
}

IntegerForms cohomology_basis(const HalfEdges& mesh, const FundamentalDomain& domain) {
  IntegerForms forms;
  forms.form_count = static_cast<int>(domain.left_over.size());
  forms.rows.resize(mesh.n_edges());
  for (int i = 0; i < forms.form_count; ++i) {
    const HalfedgeHandle h(2 * domain.left_over[i]);
    add_crossing(h, i, 1, forms);  // out of the face at h, and back to it through D
    int here = face_of(mesh, opposite(h)), there = face_of(mesh, h);
    while (here != there) {
      if (domain.face_depth[here] >= domain.face_depth[there]) {
        add_crossing(domain.to_parent_face[here], i, 1, forms);
        here = face_of(mesh, opposite(domain.to_parent_face[here]));
      } else {
        add_crossing(domain.to_parent_face[there], i, -1, forms);
        there = face_of(mesh, opposite(domain.to_parent_face[there]));
      }
    }
  }
  return forms;
}

IntegerMatrix wedge_matrix(const HalfEdges& mesh, const IntegerForms& forms, Progress& progress) {
  const int n = forms.form_count;
  IntegerMatrix twice = IntegerMatrix::Zero(n, n);
  for (int f = 0; f < static_cast<int>(mesh.n_faces()); ++f) {
    progress.step(f, mesh.n_faces(), 0.0, 0.5);
    const HalfedgeHandle h0 = mesh.halfedge_handle(mesh::FaceHandle(f)), h1 = next(mesh, h0);
    const int factor = sign(h0) * sign(h1);
    for (const auto& [i, x] : forms.rows[edge_of(h0)]) {
      for (const auto& [j, y] : forms.rows[edge_of(h1)]) {
        twice(i, j) += factor * x * y;
        twice(j, i) -= factor * x * y;
      }
    }
  }
  return twice / 2;
}

CanonicalBasis canonical_basis(const IntegerMatrix& W) {
  const auto g = W.rows() / 2;
  CanonicalBasis basis;
  basis.classes = symplectic_basis(W);
  const IntegerMatrix& S = basis.classes;
  IntegerMatrix JS(2 * g, 2 * g);
  JS << S.bottomRows(g), -S.topRows(g);
  basis.intersection = S.transpose() * JS;  // -W^-1 = S^T J S, because S W S^T = J
  basis.cycles = -JS * W;                   // S^-T = -J S W, likewise
  return basis;
}

}  // namespace holomorph::topology
