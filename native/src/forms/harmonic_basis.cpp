#include "forms/harmonic_basis.h"

#include "base/chunks.h"
#include "base/page_allocator.h"
#include "mesh/triangle_geometry.h"

namespace holomorph::forms {
namespace {

using mesh::edge_of;
using mesh::EdgeEnds;
using mesh::HalfedgeHandle;
using mesh::HalfEdges;
using mesh::next;
using mesh::sign;
using topology::forms_between;

// A column of values at the vertices for each right-hand side.
Eigen::MatrixXd zeros(Eigen::Index vertices, Eigen::Index count, Workers& workers) {
  Eigen::MatrixXd B(vertices, count);
  advise_large_pages(B.data(), B.size() * sizeof(double));
  // The system makes its pages in parallel.
  const int n = static_cast<int>(B.rows());
  run_throwing(workers, chunk_count(n), [&](int chunk) {
    const int begin = chunk * kChunk;
    B.middleRows(begin, std::min(kChunk, n - begin)).setZero();
  });
  return B;
}

}  // namespace

Eigen::MatrixXd codifferentials(const EdgeEnds& ends, std::span<const double> weights,
                                const topology::IntegerForms& classes, Workers& workers) {
  return codifferentials(ends, weights, classes, 0, classes.form_count, workers);
}

Eigen::MatrixXd codifferentials(const EdgeEnds& ends, std::span<const double> weights,
                                const topology::IntegerForms& classes, int first, int count, Workers& workers) {
  Eigen::MatrixXd B = zeros(ends.vertex_count(), count, workers);
  for (const int e : classes.rows.edges()) {
    const int head = ends.head(e), tail = ends.tail(e);
    for (const auto& [i, value] : forms_between(classes.rows[e], first, first + count)) {
      B(head, i - first) -= weights[e] * value;
      B(tail, i - first) += weights[e] * value;
    }
  }
  return B;
}

Eigen::MatrixXd codifferentials(const EdgeEnds& ends, std::span<const double> weights,
                                const topology::IntegerForms& classes, const Eigen::MatrixXd& combinations,
                                Workers& workers) {
  Eigen::MatrixXd B = zeros(ends.vertex_count(), combinations.cols(), workers);
  Eigen::RowVectorXd flux(combinations.cols());
  for (const int e : classes.rows.edges()) {
    flux.setZero();
    for (const auto& [i, value] : classes.rows[e]) flux += weights[e] * value * combinations.row(i);
    B.row(ends.head(e)) -= flux;
    B.row(ends.tail(e)) += flux;
  }
  return B;
}

ClosedForms harmonic_basis(const EdgeEnds& ends, std::span<const double> weights, const topology::IntegerForms& classes,
                           solver::LaplaceSolver& solver, solver::Condition condition, Execution& execution) {
  return {classes, solver.solve(codifferentials(ends, weights, classes, execution.workers()), condition, execution)};
}

RowMajorMatrix edge_values(const EdgeEnds& ends, const ClosedForms& forms, int begin, int end) {
  const int count = static_cast<int>(forms.functions.cols());
  RowMajorMatrix values(end - begin, count);
  for (int e = begin; e < end; ++e) {
    const int head = ends.head(e), tail = ends.tail(e);
    auto row = values.row(e - begin);
    row = forms.functions.row(head) - forms.functions.row(tail);
    for (const auto& [i, value] : forms_between(forms.classes.rows[e], forms.first, forms.first + count))
      row[i - forms.first] += value;
  }
  return values;
}

Eigen::VectorXd combination(const EdgeEnds& ends, const ClosedForms& forms, const Eigen::VectorXd& c) {
  const Eigen::VectorXd f = forms.functions * c;
  Eigen::VectorXd values(ends.edge_count());
  for (int e = 0; e < ends.edge_count(); ++e) {
    values[e] = f[ends.head(e)] - f[ends.tail(e)];
    for (const auto& [i, value] : forms.classes.rows[e]) values[e] += c[i] * value;
  }
  return values;
}

Eigen::MatrixXd class_products(const EdgeEnds& ends, std::span<const double> weights, const ClosedForms& forms) {
  RowMajorMatrix products = RowMajorMatrix::Zero(forms.classes.form_count, forms.functions.cols());
  for (const int e : forms.classes.rows.edges()) {
    const Eigen::RowVectorXd flux = weights[e] * edge_values(ends, forms, e, e + 1).row(0);
    for (const auto& [i, value] : forms.classes.rows[e]) products.row(i) += value * flux;
  }
  return products;
}

Eigen::MatrixXd periods(const EdgeEnds& ends, const ClosedForms& forms,
                        const std::vector<std::vector<HalfedgeHandle>>& loops) {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(loops.size()), forms.functions.cols());
  for (std::size_t i = 0; i < loops.size(); ++i) {
    for (const HalfedgeHandle h : loops[i]) {
      const int e = edge_of(h);
      result.row(static_cast<Eigen::Index>(i)) += sign(h) * edge_values(ends, forms, e, e + 1).row(0);
    }
  }
  return result;
}

std::vector<double> averaged_star(const HalfEdges& mesh, std::span<const double> lengths,
                                  const std::vector<double>& form) {
  std::vector<double> star(form.size(), 0.0);
  for (int f = 0; f < static_cast<int>(mesh.n_faces()); ++f) {
    HalfedgeHandle h = mesh.halfedge_handle(mesh::FaceHandle(f));
    for (int i = 0; i < 3; ++i, h = next(mesh, h)) {
      // Side h opposite corner 0, corners 1 and 2 its ends: (*w)(h) = cot_2 w(0 -> 1) + cot_1 w(0 -> 2), the flux
      // through h.
      const HalfedgeHandle to_apex = next(mesh, h), from_apex = next(mesh, to_apex);
      const double a = lengths[edge_of(h)], b = lengths[edge_of(to_apex)], c = lengths[edge_of(from_apex)];
      const double area = mesh::triangle_area(a, b, c);
      const double at_start = mesh::cotangent(b, c, a, area), at_end = mesh::cotangent(c, a, b, area);
      const double to_start = sign(from_apex) * form[edge_of(from_apex)],
                   to_end = -sign(to_apex) * form[edge_of(to_apex)];
      star[edge_of(h)] += 0.5 * sign(h) * (at_end * to_start + at_start * to_end);
    }
  }
  return star;
}

}  // namespace holomorph::forms
