#include "topology/pole_classes.h"

namespace holomorph::topology {

using mesh::edge_of;
using mesh::face_of;
using mesh::opposite;
using mesh::sign;

IntegerForms pole_classes(const HalfEdges& half_edges, const FundamentalDomain& domain,
                          const std::vector<mesh::Star>& stars) {
  const bool closed = domain.gaps.empty();
  const HalfedgeHandle out = closed ? stars.back().link[0] : opposite(domain.gaps[0]);
  IntegerForms forms;
  forms.form_count = static_cast<int>(stars.size()) - (closed ? 1 : 0);
  forms.rows.resize(half_edges.n_edges());
  for (int i = 0; i < forms.form_count; ++i) {
    int here = face_of(half_edges, stars[i].link[0]), there = face_of(half_edges, out);
    // Up from both ends to their common ancestor in D. Faces of stars are leaves of D, so no path crosses another star.
    while (here != there) {
      const bool leaving = domain.face_rank[here] > domain.face_rank[there];
      int& face = leaving ? here : there;
      const HalfedgeHandle h = domain.to_parent_face[face];
      forms.rows.edit(edge_of(h)).emplace_back(i, leaving ? sign(h) : -sign(h));
      face = face_of(half_edges, opposite(h));
    }
    // Through the gap of boundary loop 0, out of the surface.
    if (!closed) forms.rows.edit(edge_of(out)).emplace_back(i, sign(out));
  }
  return forms;
}

}  // namespace holomorph::topology
