#include "forms/harmonic_residuals.h"

#include "base/chunks.h"
#include "base/double_double.h"

namespace holomorph::forms {
namespace {

using mesh::HalfedgeHandle;
using mesh::HalfEdges;

// The flux of all forms out of a vertex, and their energy there, half of that of its edges.
class AtVertex {
 public:
  AtVertex(const HalfEdges& half_edges, std::span<const double> weights, const FluxTerms& terms,
           const RowMajorMatrix& functions)
      : mesh_(half_edges), weights_(weights), terms_(terms), functions_(functions) {}

  std::vector<DoubleDouble> flux;

  void begin(int v) {
    flux.assign(functions_.cols(), {});
    for (Eigen::Index i = 0; i < terms_.sources.cols(); ++i) flux[i].high = terms_.sources(v, i);
  }

  void add(HalfedgeHandle h, Eigen::RowVectorXd& energies) {
    const int head = mesh::to_vertex(mesh_, h), tail = mesh::from_vertex(mesh_, h), e = mesh::edge_of(h);
    const double k = weights_[e], outer = terms_.outer_weights.empty() ? k : terms_.outer_weights[e];
    const bool everywhere = fill(terms_.eta, h, eta_), outside = fill(terms_.outer_eta, h, outer_eta_);
    for (Eigen::Index i = 0; i < functions_.cols(); ++i) {
      // The difference comes first, exactly: then a large weight multiplies a small number.
      DoubleDouble value = exact_sum(functions_(head, i), -functions_(tail, i));
      if (everywhere) value = value + DoubleDouble{eta_[i]};
      flux[i] = flux[i] + DoubleDouble{k} * value;
      const double whole = value.high + (outside ? outer_eta_[i] : 0);
      if (outside) flux[i] = flux[i] + DoubleDouble{outer} * DoubleDouble{outer_eta_[i]};
      // Half of an edge's energy goes to each end. Where outer < k, inside a star, the rest of k weighs df + eta
      // without the singular part.
      energies[i] += 0.5 * (outer * whole * whole + (k - outer) * value.high * value.high);
    }
  }

 private:
  bool fill(const AddValues& form, HalfedgeHandle h, Eigen::VectorXd& values) const {
    if (!form) return false;
    values.setZero(functions_.cols());
    form(h, values);
    return true;
  }

  const HalfEdges& mesh_;
  std::span<const double> weights_;
  const FluxTerms& terms_;
  const RowMajorMatrix& functions_;
  Eigen::VectorXd eta_, outer_eta_;
};

}  // namespace

FluxTerms class_terms(const topology::IntegerForms& classes, int first, int count) {
  return {[&classes, first, count](HalfedgeHandle h, Eigen::VectorXd& values) {
    for (const auto& [i, value] : topology::forms_between(classes.rows[mesh::edge_of(h)], first, first + count))
      values[i - first] += mesh::sign(h) * value;
  }};
}

FluxTerms class_terms(const topology::IntegerForms& classes, const Eigen::MatrixXd& combinations) {
  return {[&classes, combinations](HalfedgeHandle h, Eigen::VectorXd& values) {
    for (const auto& [i, value] : classes.rows[mesh::edge_of(h)])
      values += mesh::sign(h) * value * combinations.row(i).transpose();
  }};
}

FluxTerms function_terms(const HalfEdges& half_edges, RowMajorMatrix functions) {
  return {[&half_edges, g = std::move(functions)](HalfedgeHandle h, Eigen::VectorXd& values) {
    values += (g.row(mesh::to_vertex(half_edges, h)) - g.row(mesh::from_vertex(half_edges, h))).transpose();
  }};
}

HarmonicResiduals harmonic_residuals(const HalfEdges& half_edges, std::span<const double> weights,
                                     const FluxTerms& terms, const RowMajorMatrix& functions, Workers& workers) {
  const int vertices = static_cast<int>(functions.rows()), chunks = chunk_count(vertices);
  const Eigen::RowVectorXd none = Eigen::RowVectorXd::Zero(functions.cols());
  HarmonicResiduals result{Eigen::MatrixXd(functions.rows(), functions.cols()), none};
  std::vector<Eigen::RowVectorXd> energies(chunks, none);
  run_throwing(workers, chunks, [&](int chunk) {
    AtVertex here(half_edges, weights, terms, functions);
    for (int v = chunk * kChunk, end = std::min(v + kChunk, vertices); v < end; ++v) {
      here.begin(v);
      const HalfedgeHandle start = half_edges.halfedge_handle(mesh::VertexHandle(v));
      HalfedgeHandle h = start;
      do {
        here.add(h, energies[chunk]);
        h = next(half_edges, mesh::opposite(h));
      } while (h != start);
      for (Eigen::Index i = 0; i < functions.cols(); ++i) result.R(v, i) = here.flux[i].value();
    }
  });
  for (const Eigen::RowVectorXd& part : energies) result.energies += part;
  return result;
}

}  // namespace holomorph::forms
