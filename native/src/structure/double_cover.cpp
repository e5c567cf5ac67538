#include "structure/double_cover.h"

namespace holomorph::structure {

using mesh::DoubleCover;
using mesh::edge_of;
using mesh::HalfedgeHandle;
using topology::IntegerForms;

DoubledSurface doubled(const mesh::Discretisation& surface, Execution& execution) {
  DoubledSurface result{mesh::double_cover(surface.half_edges, execution), {}};
  const auto& [half_edges, dual_vertex, first, second] = result.cover;
  result.weights.resize(half_edges.n_edges(), 0.0);
  for (int e = 0; e < static_cast<int>(surface.weights.size()); ++e) {
    // Copies are known by half-edges that have a face. Both copies of a boundary edge are one edge of the double, which
    // gets the weight twice: the cotangents of both its faces.
    const bool is_outside = surface.half_edges.is_boundary(HalfedgeHandle(2 * e));
    const int h = is_outside ? 2 * e + 1 : 2 * e;
    result.weights[edge_of(first[h])] += surface.weights[e];
    result.weights[edge_of(second[h])] += surface.weights[e];
  }
  return result;
}

IntegerForms extended(const mesh::HalfEdges& half_edges, const DoubleCover& cover, const IntegerForms& forms,
                      int natural) {
  static const IntegerForms::Row kZero;
  IntegerForms both;
  both.form_count = forms.form_count;
  both.rows.resize(cover.half_edges.n_edges());
  for (int i = 0; i < static_cast<int>(half_edges.n_halfedges()); ++i) {
    const HalfedgeHandle h(i);
    if (!half_edges.face_handle(h).is_valid()) continue;
    const HalfedgeHandle a = cover.first[i], b = cover.second[i];
    const auto& row = forms.rows[edge_of(h)];
    IntegerForms::Row dual = row;
    for (auto& [form, value] : dual) value = form < natural ? value : -value;
    // The second copy is written first, so that on a shared boundary edge the value of the first copy stays.
    both.rows.set(edge_of(b), topology::add(kZero, dual, mesh::sign(h) * mesh::sign(b)));
    both.rows.set(edge_of(a), topology::add(kZero, row, mesh::sign(h) * mesh::sign(a)));
  }
  return both;
}

forms::RowMajorMatrix symmetrised(const forms::RowMajorMatrix& f, const DoubleCover& cover, int natural) {
  const auto count = static_cast<Eigen::Index>(cover.dual_vertex.size());
  Eigen::RowVectorXd parity = Eigen::RowVectorXd::Constant(f.cols(), -1);
  parity.head(natural).setOnes();
  forms::RowMajorMatrix result(count, f.cols());
  for (Eigen::Index v = 0; v < count; ++v)
    result.row(v) = (f.row(v) + parity.cwiseProduct(f.row(cover.dual_vertex[v]))) / 2;
  return result;
}

}  // namespace holomorph::structure
