#include "forms/closed_forms.h"

#include <algorithm>

#include "base/page_allocator.h"
#include "base/workers.h"

namespace holomorph::forms {
namespace {

using mesh::EdgeEnds;
using mesh::HalfedgeHandle;

// Edges whose values are written at a time.
constexpr int kEdgeBlock = 4096;

// A column of values at the vertices for each right-hand side; the system makes its pages in parallel.
Eigen::MatrixXd zeros(Eigen::Index vertices, Eigen::Index count, Workers& workers) {
  Eigen::MatrixXd B(vertices, count);
  advise_large_pages(B.data(), B.size() * sizeof(double));
  const int n = static_cast<int>(B.rows());
  run_throwing(workers, chunk_count(n), [&](int chunk) {
    const int begin = chunk * kChunk;
    B.middleRows(begin, std::min(kChunk, n - begin)).setZero();
  });
  return B;
}

}  // namespace

RowMajorMatrix edge_values(const EdgeEnds& ends, const ClosedForms& forms, int begin, int end) {
  const int count = static_cast<int>(forms.functions.cols());
  RowMajorMatrix values(end - begin, count);
  for (int e = begin; e < end; ++e) {
    auto row = values.row(e - begin);
    // omega = df + eta, along the edge.
    row = forms.functions.row(ends.head(e)) - forms.functions.row(ends.tail(e));
    for (const auto& [i, value] : topology::forms_between(forms.classes.rows[e], forms.first, forms.first + count))
      row[i - forms.first] += value;
  }
  return values;
}

void write_edge_values(const EdgeEnds& ends, const ClosedForms& forms, Eigen::Ref<RowMajorMatrix> rows) {
  const auto edges = static_cast<int>(rows.cols());
  for (int begin = 0, end; begin < edges; begin = end) {
    end = std::min(begin + kEdgeBlock, edges);
    rows.middleCols(begin, end - begin) = edge_values(ends, forms, begin, end).transpose();
  }
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

Eigen::MatrixXd periods(const EdgeEnds& ends, const ClosedForms& forms,
                        const std::vector<std::vector<HalfedgeHandle>>& loops) {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(loops.size()), forms.functions.cols());
  for (std::size_t i = 0; i < loops.size(); ++i) {
    for (const HalfedgeHandle h : loops[i]) {
      const int e = mesh::edge_of(h);
      result.row(static_cast<Eigen::Index>(i)) += mesh::sign(h) * edge_values(ends, forms, e, e + 1).row(0);
    }
  }
  return result;
}

double period_residual(const EdgeEnds& ends, const ClosedForms& forms,
                       const std::vector<std::vector<HalfedgeHandle>>& loops) {
  const auto dual =
      std::min<Eigen::Index>(forms.functions.cols(), static_cast<Eigen::Index>(loops.size()) - forms.first);
  if (dual <= 0) return 0;
  // Form j belongs to class first + j, which is dual to that loop. Forms beyond the loops have no dual one.
  Eigen::MatrixXd found = periods(ends, forms, loops).leftCols(dual);
  for (Eigen::Index j = 0; j < dual; ++j) found(forms.first + j, j) -= 1;
  return found.cwiseAbs().maxCoeff();
}

Eigen::MatrixXd codifferentials(const EdgeEnds& ends, std::span<const double> weights,
                                const topology::IntegerForms& classes, Workers& workers) {
  return codifferentials(ends, weights, classes, 0, classes.form_count, workers);
}

Eigen::MatrixXd codifferentials(const EdgeEnds& ends, std::span<const double> weights,
                                const topology::IntegerForms& classes, int first, int count, Workers& workers) {
  Eigen::MatrixXd B = zeros(ends.vertex_count(), count, workers);
  for (const int e : classes.rows.edges()) {
    // d^T adds a flux at the head and subtracts it at the tail; the signs are those of -d^T. Edges where all classes
    // are 0 add nothing.
    const int head = ends.head(e), tail = ends.tail(e);
    for (const auto& [i, value] : topology::forms_between(classes.rows[e], first, first + count)) {
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

Eigen::MatrixXd codifferentials(const EdgeEnds& ends, std::span<const double> weights,
                                const RowMajorMatrix& edge_values, Workers& workers) {
  Eigen::MatrixXd B = zeros(ends.vertex_count(), edge_values.cols(), workers);
  for (int e = 0; e < ends.edge_count(); ++e) {
    B.row(ends.head(e)) -= weights[e] * edge_values.row(e);
    B.row(ends.tail(e)) += weights[e] * edge_values.row(e);
  }
  return B;
}

Eigen::MatrixXd class_products(const EdgeEnds& ends, std::span<const double> weights,
                               const topology::IntegerForms& classes, const ClosedForms& forms) {
  RowMajorMatrix products = RowMajorMatrix::Zero(classes.form_count, forms.functions.cols());
  for (const int e : classes.rows.edges()) {
    if (classes.rows[e].empty()) continue;
    const Eigen::RowVectorXd flux = weights[e] * edge_values(ends, forms, e, e + 1).row(0);
    for (const auto& [i, value] : classes.rows[e]) products.row(i) += value * flux;
  }
  return products;
}

}  // namespace holomorph::forms
