#include "forms/closed_forms.h"

#include <algorithm>

namespace holomorph::forms {
namespace {

using mesh::EdgeEnds;
using mesh::HalfedgeHandle;

// Edges whose values are written at a time.
constexpr int kEdgeBlock = 4096;

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

}  // namespace holomorph::forms
