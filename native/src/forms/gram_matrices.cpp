#include "forms/gram_matrices.h"

#include <array>
#include <cmath>
#include <utility>

#include "base/constants.h"
#include "base/double_double.h"
#include "linear/blas.h"

namespace holomorph::forms {

using mesh::edge_of;
using mesh::HalfedgeHandle;
using mesh::next;
using mesh::opposite;
using mesh::sign;

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using mesh::HalfEdges;

// Unit roundoff of a double.
// Edges that are summed before their sum is added to that of a block: short sums round less.
constexpr int kPart = 64;
// The same where forms are many: edges of a block, whose values are there at once, of a part, and columns of a product.
constexpr int kManyBlock = 1024, kManyPart = 128, kPanel = 64;
// Part of the edges whose relative errors are at most the usual one; the largest that this may be.
constexpr double kUsual = 0.95, kMostUsual = 0x1p-20;

// Sums over some edges, for each family.
struct Sums {
  std::vector<MatrixXd> value, uncertain;
  std::vector<VectorXd> size;

  explicit Sums(const std::vector<int>& families) {
    for (const int n : families) {
      value.push_back(MatrixXd::Zero(n, n));
      uncertain.push_back(MatrixXd::Zero(n, n));
      size.push_back(VectorXd::Zero(n));
    }
  }
  void set_zero() {
    for (std::size_t i = 0; i < value.size(); ++i) {
      value[i].setZero();
      uncertain[i].setZero();
      size[i].setZero();
    }
  }
  void operator+=(const Sums& other) {
    for (std::size_t i = 0; i < value.size(); ++i) {
      value[i] += other.value[i];
      uncertain[i] += other.uncertain[i];
      size[i] += other.size[i];
    }
  }
};

struct WeightedForms {
  const HalfEdges& half_edges;
  std::span<const double> weights, errors;
  const ClosedForms& forms;
};

// Two forms of one family: several times faster where their number is known in advance.
void add_two(const WeightedForms& w, int begin, int end, Sums& sums) {
  const double* f = w.forms.functions.data();
  Eigen::Matrix2d value = Eigen::Matrix2d::Zero(), uncertain = Eigen::Matrix2d::Zero();
  Eigen::Vector2d size = Eigen::Vector2d::Zero();
  for (int e = begin; e < end; ++e) {
    const double k = w.weights[e];
    if (k == 0 && (w.errors.empty() || w.errors[e] == 0)) continue;
    const int head = mesh::to_vertex(w.half_edges, HalfedgeHandle(2 * e)),
              tail = mesh::from_vertex(w.half_edges, HalfedgeHandle(2 * e));
    Eigen::Vector2d h(f[2 * head] - f[2 * tail], f[2 * head + 1] - f[2 * tail + 1]);
    for (const auto& [i, integer] : topology::forms_between(w.forms.classes.rows[e], w.forms.first, w.forms.first + 2))
      h[i - w.forms.first] += integer;
    const Eigen::Matrix2d product = h * h.transpose();
    value += k * product;
    if (w.errors.empty()) continue;
    uncertain += w.errors[e] * product;
    size += (std::abs(k) + std::abs(w.errors[e])) * h.cwiseAbs2();
  }
  sums.value[0] += value;
  sums.uncertain[0] += uncertain;
  sums.size[0] += size;
}

void add_all(const WeightedForms& w, const std::vector<int>& families, int begin, int end, Sums& sums) {
  const auto k = Eigen::Map<const VectorXd>(w.weights.data() + begin, end - begin);
  const auto errors = w.errors.empty() ? w.errors : w.errors.subspan(begin, end - begin);
  const auto u = Eigen::Map<const VectorXd>(errors.data(), static_cast<Index>(errors.size()));
  if ((k.array() == 0).all() && (u.array() == 0).all()) return;
  const RowMajorMatrix values = edge_values(w.half_edges, w.forms, begin, end);
  int first = 0;
  for (std::size_t i = 0; i < families.size(); first += families[i++]) {
    const auto h = values.middleCols(first, families[i]);
    sums.value[i] += h.transpose() * (k.asDiagonal() * h);
    if (w.errors.empty()) continue;
    sums.uncertain[i] += h.transpose() * (u.asDiagonal() * h);
    sums.size[i] += h.cwiseAbs2().transpose() * (k.cwiseAbs() + u.cwiseAbs());
  }
}

// Columns of the Gram matrix of one family that one thread sums.
struct Panel {
  std::size_t family = 0;
  Index begin = 0, first = 0, width = 0;  // of the family, of the panel in it, its columns
};

std::vector<Panel> panels_of(const std::vector<int>& families) {
  std::vector<Panel> panels;
  Index begin = 0;
  for (std::size_t i = 0; i < families.size(); begin += families[i++]) {
    for (Index first = 0; first < families[i]; first += kPanel)
      panels.push_back({i, begin, first, std::min<Index>(kPanel, families[i] - first)});
  }
  return panels;
}

// Adds to the lower part of a panel's columns what the edges of a block give, with these weights.
void add_panel(const RowMajorMatrix& values, const VectorXd& weights, const Panel& panel, Index count, MatrixXd& sum) {
  const Index rest = count - panel.first;
  const Eigen::Map<const MatrixXd> transposed(values.data(), values.cols(), values.rows());
  MatrixXd of_block = MatrixXd::Zero(rest, panel.width);
  for (Index part = 0; part < values.rows(); part += kManyPart) {
    const Index edges = std::min<Index>(kManyPart, values.rows() - part);
    const auto h = transposed.block(panel.begin + panel.first, part, rest, edges);
    const MatrixXd weighted = h.topRows(panel.width) * weights.segment(part, edges).asDiagonal();
    linear::add_product_transposed(h, weighted, of_block);
  }
  sum.block(panel.first, panel.first, rest, panel.width) += of_block;
}

// A factor with u_e <= rho k_e on most edges. Then sum u_e h h^T <= rho G + sum excess_e h h^T, with
// excess_e = max(0, u_e - rho k_e), which few edges have: half of the work for all errors.
double usual_error(const WeightedForms& w) {
  std::vector<double> relative;
  for (std::size_t e = 0; e < w.errors.size(); ++e) {
    if (w.weights[e] > 0) relative.push_back(w.errors[e] / w.weights[e]);
  }
  if (relative.empty()) return 0;
  const auto most = relative.begin() + static_cast<std::ptrdiff_t>(kUsual * static_cast<double>(relative.size()));
  std::nth_element(relative.begin(), most, relative.end());
  return std::min(*most, kMostUsual);
}

// The values of edges of a block that have an excess, and the excess.
std::pair<RowMajorMatrix, VectorXd> excess_of(const RowMajorMatrix& values, const VectorXd& excess) {
  std::vector<Index> edges;
  for (Index e = 0; e < excess.size(); ++e) {
    if (excess[e] > 0) edges.push_back(e);
  }
  return {values(edges, Eigen::all), excess(edges)};
}

// One Gram matrix for all threads: its panels are summed side by side, block after block of edges.
Sums sums_of_many(const WeightedForms& w, const std::vector<int>& families, Execution& execution) {
  Sums sums(families);
  const std::vector<Panel> panels = panels_of(families);
  const auto edges = static_cast<int>(w.weights.size());
  const double rho = usual_error(w);
  RowMajorMatrix values;
  for (int begin = 0; begin < edges; begin += kManyBlock) {
    const int count = std::min(kManyBlock, edges - begin);
    const VectorXd k = Eigen::Map<const VectorXd>(w.weights.data() + begin, count);
    VectorXd u = VectorXd::Zero(count);
    if (!w.errors.empty()) u = Eigen::Map<const VectorXd>(w.errors.data() + begin, count);
    if (k.isZero(0) && u.isZero(0)) continue;
    values.resize(count, w.forms.functions.cols());
    run_long_tasks(execution.workers(), (count + kPart - 1) / kPart, [&](int part) {
      const int from = part * kPart, to = std::min(from + kPart, count);
      values.middleRows(from, to - from) = edge_values(w.half_edges, w.forms, begin + from, begin + to);
    });
    const auto [uncertain, excess] = excess_of(values, (1 + 16 * kUnit) * (u - rho * k));
    run_long_tasks(execution.workers(), static_cast<int>(panels.size()), [&](int p) {
      const Panel& panel = panels[p];
      add_panel(values, k, panel, families[panel.family], sums.value[panel.family]);
      if (w.errors.empty()) return;
      add_panel(uncertain, excess, panel, families[panel.family], sums.uncertain[panel.family]);
      const auto h = values.middleCols(panel.begin + panel.first, panel.width);
      sums.size[panel.family].segment(panel.first, panel.width) +=
          h.cwiseAbs2().transpose() * (k.cwiseAbs() + u.cwiseAbs());
    });
    execution.report(static_cast<double>(begin + count) / edges);
  }
  for (std::size_t i = 0; i < families.size(); ++i) {
    sums.uncertain[i] += rho * (1 + 8 * kUnit) * sums.value[i];  // u - rho k was rounded
    for (MatrixXd* sum : {&sums.value[i], &sums.uncertain[i]})
      sum->triangularView<Eigen::StrictlyUpper>() = sum->transpose();
  }
  return sums;
}

// Sums of few forms: each block of edges has its own.
Sums sums_of_few(const WeightedForms& w, const std::vector<int>& families, Execution& execution) {
  const bool two = families == std::vector<int>{2};
  Sums total(families);
  std::vector<Sums> slots(kBatch, total);
  for_blocks(
      w.weights.size(), execution, 0.0, 1.0,
      [&](int slot, int begin, int end) {
        slots[slot].set_zero();
        for (int part = begin; part < end; part += kPart) {
          const int last = std::min(part + kPart, end);
          two ? add_two(w, part, last, slots[slot]) : add_all(w, families, part, last, slots[slot]);
        }
      },
      [&](int slot) { total += slots[slot]; });
  return total;
}

VectorXd cut_sizes(const WeightedForms& w) {
  VectorXd result = VectorXd::Zero(w.forms.functions.cols());
  const int first = w.forms.first, last = first + static_cast<int>(result.size());
  for (const int e : w.forms.classes.rows.edges()) {
    for (const auto& [i, value] : topology::forms_between(w.forms.classes.rows[e], first, last))
      result[i - first] += (std::abs(w.weights[e]) + std::abs(w.errors[e])) * value * value;
  }
  return result;
}

}  // namespace

std::vector<GramMatrix> gram_matrices(const HalfEdges& half_edges, std::span<const double> weights,
                                      std::span<const double> errors, const ClosedForms& forms,
                                      const std::vector<int>& families, Execution& execution) {
  const WeightedForms weighted{half_edges, weights, errors, forms};
  const bool are_many = forms.functions.cols() > linear::kSmall;
  Sums total = are_many ? sums_of_many(weighted, families, execution) : sums_of_few(weighted, families, execution);
  const VectorXd cut = errors.empty() ? VectorXd() : cut_sizes(weighted);
  const int edges = static_cast<int>(weights.size());
  for (const int count : families) Execution::count(static_cast<double>(weights.size()) * count * count);
  std::vector<GramMatrix> result;
  for (std::size_t i = 0, first = 0; i < families.size(); first += families[i++]) {
    const auto symmetric = [](const MatrixXd& A) { return MatrixXd((A + A.transpose()) / 2); };
    result.push_back({symmetric(total.value[i]), symmetric(total.uncertain[i]), total.size[i], {}, 0});
    if (!errors.empty()) result[i].cut_size = cut.segment(static_cast<Index>(first), families[i]);
    // Lengths of the nested sums: over a part, over the parts of a block, over the blocks.
    const int part = are_many ? kManyPart : kPart, block = are_many ? kManyBlock : kBlock;
    result[i].summands = std::min(edges, part) + std::min(edges / part + 1, block / part) + edges / block + 1;
  }
  return result;
}

// Sums: |rounding of sum k h_i h_j| <= c sum |k h_i h_j|, which as a quadratic form is at most n c diag(size). Values:
// h = (f - f) + eta is wrong by |delta| <= 2 |h| + |eta| units. So 2 <h, delta> + <delta, delta> is at most 3 epsilon n
// diag(size), by Cauchy and Schwarz, with epsilon^2 >= |delta|^2 / |h|^2.
MatrixXd gram_errors(const GramMatrix& gram) {
  const auto n = static_cast<double>(gram.size.size());
  double relative = 0;
  for (Index i = 0; i < gram.size.size(); ++i)
    relative = std::max(relative, gram.size[i] > 0 ? gram.cut_size[i] / gram.size[i] : 0.0);
  const double of_values = kUnit * std::sqrt(8 + 2 * relative);
  const double of_sums = kUnit * (gram.summands + 6);  // and the products, the last mean and sum
  MatrixXd errors = gram.uncertain;
  // A sum as well, and rounded; and the rounding of G where a part of it stands for errors.
  errors.diagonal() += n * (1 + 2 * (of_sums + kMostUsual)) * (of_sums + 3 * of_values) * gram.size;
  return errors;
}

std::vector<double> averaged_star(const mesh::IntrinsicTriangulation& triangulation, const std::vector<double>& form) {
  const mesh::HalfEdges& half_edges = triangulation.half_edges;
  std::vector<double> star(form.size(), 0.0);
  for (int f = 0; f < static_cast<int>(half_edges.n_faces()); ++f) {
    HalfedgeHandle h = half_edges.halfedge_handle(mesh::FaceHandle(f));
    for (int i = 0; i < 3; ++i, h = next(half_edges, h)) {
      // Side h opposite corner 0, corners 1 and 2 its ends: (*w)(h) = cot_2 w(0 -> 1) + cot_1 w(0 -> 2), the flux
      // through h.
      const HalfedgeHandle to_apex = next(half_edges, h), from_apex = next(half_edges, to_apex);
      const double at_start = triangulation.cotangents[to_apex.idx()];
      const double at_end = triangulation.cotangents[from_apex.idx()];
      const double to_start = sign(from_apex) * form[edge_of(from_apex)],
                   to_end = -sign(to_apex) * form[edge_of(to_apex)];
      // A face of an edge has half a vote, the only face of a boundary edge a whole one.
      const double share = half_edges.is_boundary(opposite(h)) ? 1.0 : 0.5;
      star[edge_of(h)] += share * sign(h) * (at_end * to_start + at_start * to_end);
    }
  }
  return star;
}

}  // namespace holomorph::forms
