#include "structure/double_cover.h"

#include "mesh/double_cover.h"

namespace holomorph::structure {
namespace {

using mesh::DoubleCover;
using mesh::edge_of;
using mesh::HalfedgeHandle;
using topology::IntegerForms;

// Each form on both copies: the same along dual half-edges for the natural ones, the negative for the others.
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
    both.rows.set(edge_of(b), topology::add(kZero, dual, mesh::sign(h) * mesh::sign(b)));
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

// (f(v) + f(v*)) / 2 of the natural functions, (f(v) - f(v*)) / 2 of the others.
forms::RowMajorMatrix symmetrised(const forms::RowMajorMatrix& f, const DoubleCover& cover, int natural) {
  const auto count = static_cast<Eigen::Index>(cover.dual_vertex.size());
  Eigen::RowVectorXd parity = Eigen::RowVectorXd::Constant(f.cols(), -1);
  parity.head(natural).setOnes();
  forms::RowMajorMatrix result(count, f.cols());
  for (Eigen::Index v = 0; v < count; ++v)
    result.row(v) = (f.row(v) + parity.cwiseProduct(f.row(cover.dual_vertex[v]))) / 2;
  return result;
}

}  // namespace

HarmonicFunctions solve_on_double(const mesh::HalfEdges& half_edges, std::span<const double> weights,
                                  const IntegerForms& classes, int natural, const Options& options,
                                  Execution& execution) {
  const DoubleCover cover = mesh::double_cover(half_edges, execution);
  const auto double_weights = weights_of_double(half_edges, cover, weights);
  const int count = classes.form_count;
  const MemoryPlan plan = plan_memory({static_cast<std::int64_t>(cover.half_edges.n_vertices()),
                                       static_cast<std::int64_t>(double_weights.size()), count},
                                      options.solver, options.memory_limit, Keeping::all);
  HarmonicSystems systems(cover.half_edges, double_weights, {}, plan.choice, execution);
  auto solved = systems.solve(extended(half_edges, cover, classes, natural), count, plan.block, execution);
  return {symmetrised(solved.functions, cover, natural), std::move(solved.solver)};
}

}  // namespace holomorph::structure
