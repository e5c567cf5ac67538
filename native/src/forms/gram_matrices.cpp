#include "forms/gram_matrices.h"

#include <array>
#include <cmath>
#include <limits>

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
constexpr double kUnit = std::numeric_limits<double>::epsilon() / 2;
// Edges that are summed before their sum is added to that of a block: short sums round less.
constexpr int kPart = 64;

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
  const bool two = families == std::vector<int>{2};
  Sums total(families);
  std::vector<Sums> slots(kBatch, total);
  for_blocks(
      weights.size(), execution, 0.0, 1.0,
      [&](int slot, int begin, int end) {
        slots[slot].set_zero();
        for (int part = begin; part < end; part += kPart) {
          const int last = std::min(part + kPart, end);
          two ? add_two(weighted, part, last, slots[slot]) : add_all(weighted, families, part, last, slots[slot]);
        }
      },
      [&](int slot) { total += slots[slot]; });
  const VectorXd cut = errors.empty() ? VectorXd() : cut_sizes(weighted);
  const int edges = static_cast<int>(weights.size());
  for (const int count : families) execution.count(weights.size() * static_cast<std::size_t>(count) * count);
  std::vector<GramMatrix> result;
  for (std::size_t i = 0, first = 0; i < families.size(); first += families[i++]) {
    const auto symmetric = [](const MatrixXd& A) { return MatrixXd((A + A.transpose()) / 2); };
    result.push_back({symmetric(total.value[i]), symmetric(total.uncertain[i]), total.size[i], {}, 0});
    if (!errors.empty()) result[i].cut_size = cut.segment(static_cast<Index>(first), families[i]);
    // Lengths of the nested sums: over a part, over the parts of a block, over the blocks.
    result[i].summands = std::min(edges, kPart) + std::min(edges / kPart + 1, kBlock / kPart) + edges / kBlock + 1;
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
  errors.diagonal() += n * (1 + 2 * of_sums) * (of_sums + 3 * of_values) * gram.size;  // a sum as well, and rounded
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
