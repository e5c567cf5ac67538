#include "forms/harmonic_residuals.h"

#include "base/chunks.h"
#include "base/double_double.h"

namespace holomorph::forms {
namespace {

using mesh::HalfedgeHandle;
using mesh::HalfEdges;

// f_head - f_tail + class, exactly.
DoubleDouble difference(double head, double tail, double integer) {
  const DoubleDouble rise = exact_sum(head, -tail), sum = exact_sum(rise.high, integer);
  return quick_sum(sum.high, sum.low + rise.low);
}

// The flux of all forms out of a vertex, and their energy there, half of that of its edges.
struct AtVertex {
  std::vector<DoubleDouble> flux;
  std::vector<double> integers;

  void add(const HalfEdges& mesh, double weight, const topology::IntegerForms& classes, int first,
           const RowMajorMatrix& functions, HalfedgeHandle h, Eigen::RowVectorXd& energies) {
    const int head = mesh::to_vertex(mesh, h), tail = mesh::from_vertex(mesh, h), e = mesh::edge_of(h);
    const int count = static_cast<int>(flux.size());
    integers.assign(count, 0.0);
    for (const auto& [i, value] : topology::forms_between(classes.rows[e], first, first + count))
      integers[i - first] = mesh::sign(h) * value;
    for (int i = 0; i < count; ++i) {
      const DoubleDouble value = difference(functions(head, i), functions(tail, i), integers[i]);
      flux[i] = flux[i] + DoubleDouble{weight} * value;
      energies[i] += 0.5 * weight * value.high * value.high;
    }
  }
};

}  // namespace

HarmonicResiduals harmonic_residuals(const HalfEdges& mesh, std::span<const double> weights,
                                     const topology::IntegerForms& classes, int first, const RowMajorMatrix& functions,
                                     Workers& workers) {
  const int vertices = static_cast<int>(functions.rows()), chunks = chunk_count(vertices);
  const Eigen::RowVectorXd none = Eigen::RowVectorXd::Zero(functions.cols());
  HarmonicResiduals result{Eigen::MatrixXd(functions.rows(), functions.cols()), none};
  std::vector<Eigen::RowVectorXd> energies(chunks, none);
  run_throwing(workers, chunks, [&](int chunk) {
    AtVertex here;
    for (int v = chunk * kChunk, end = std::min(v + kChunk, vertices); v < end; ++v) {
      here.flux.assign(functions.cols(), {});
      const HalfedgeHandle start = mesh.halfedge_handle(mesh::VertexHandle(v));
      HalfedgeHandle h = start;
      do {
        here.add(mesh, weights[mesh::edge_of(h)], classes, first, functions, h, energies[chunk]);
        h = next(mesh, mesh::opposite(h));
      } while (h != start);
      for (Eigen::Index i = 0; i < functions.cols(); ++i) result.R(v, i) = here.flux[i].value();
    }
  });
  for (const Eigen::RowVectorXd& part : energies) result.energies += part;
  return result;
}

}  // namespace holomorph::forms
