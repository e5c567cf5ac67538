#include "pipeline/double_cover_forms.h"

#include "mesh/double_cover.h"
#include "topology/homology.h"

namespace holomorph::pipeline {
namespace {

using mesh::DoubleCover;
using mesh::edge_of;
using mesh::HalfedgeHandle;
using topology::IntegerForms;

// Each form on both copies: the same along dual half-edges (parity 1), or the negative (parity -1).
IntegerForms extended(const mesh::HalfEdges& half_edges, const DoubleCover& cover, const IntegerForms& forms,
                      int parity) {
  static const IntegerForms::Row kZero;
  IntegerForms both;
  both.form_count = forms.form_count;
  both.rows.resize(cover.half_edges.n_edges());
  for (int i = 0; i < static_cast<int>(half_edges.n_halfedges()); ++i) {
    const HalfedgeHandle h(i);
    if (!half_edges.face_handle(h).is_valid()) continue;
    const HalfedgeHandle a = cover.first[i], b = cover.second[i];
    const auto& row = forms.rows[edge_of(h)];
    both.rows.set(edge_of(b), topology::add(kZero, row, parity * mesh::sign(h) * mesh::sign(b)));
    both.rows.set(edge_of(a), topology::add(kZero, row, mesh::sign(h) * mesh::sign(a)));
  }
  return both;
}

Array<double> weights_of_double(const mesh::HalfEdges& half_edges, const DoubleCover& cover,
                                std::span<const double> weights) {
  Array<double> both(cover.half_edges.n_edges(), 0.0);
  for (int e = 0; e < static_cast<int>(weights.size()); ++e) {
    const HalfedgeHandle h(half_edges.is_boundary(HalfedgeHandle(2 * e)) ? 2 * e + 1 : 2 * e);
    both[edge_of(cover.first[h.idx()])] += weights[e];
    both[edge_of(cover.second[h.idx()])] += weights[e];
  }
  return both;
}

// (f(v) + parity f(v*)) / 2
forms::RowMajorMatrix symmetrised(const Eigen::MatrixXd& f, const DoubleCover& cover, int parity) {
  const auto count = static_cast<Eigen::Index>(cover.dual_vertex.size());
  forms::RowMajorMatrix result(count, f.cols());
  for (Eigen::Index v = 0; v < count; ++v) result.row(v) = (f.row(v) + parity * f.row(cover.dual_vertex[v])) / 2;
  return result;
}

}  // namespace

BoundedForms double_cover_forms(const mesh::HalfEdges& half_edges, std::span<const double> weights,
                                const IntegerForms& classes, const mesh::BoundaryLoops& boundary,
                                const Options& options, Execution& execution) {
  const int n = classes.form_count, handles = n - (boundary.count() - 1);
  const DoubleCover cover = mesh::double_cover(half_edges, execution);
  auto relative = topology::first_forms(classes, handles, handles);
  topology::add_loop_indicators(half_edges, boundary, relative);
  const IntegerForms both = topology::beside(extended(half_edges, cover, classes, 1),  //
                                             extended(half_edges, cover, relative, -1));
  const auto double_weights = weights_of_double(half_edges, cover, weights);
  auto laplacian = forms::laplacian(cover.half_edges, double_weights, execution);
  const auto solved = harmonic_forms(cover.half_edges, double_weights, std::move(laplacian), both, options, execution);

  BoundedForms result;
  result.natural = {classes, symmetrised(solved.forms.functions.leftCols(n), cover, 1)};
  result.dirichlet = {topology::first_forms(classes, handles, n),
                      symmetrised(solved.forms.functions.rightCols(n), cover, -1)};
  add_indicators(boundary, handles, result.dirichlet.functions);
  result.solver = solved.solver;
  return result;
}

}  // namespace holomorph::pipeline
