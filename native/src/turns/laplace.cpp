#include "turns/laplace.h"

namespace holomorph::turns {
namespace {

constexpr double kRegular = 1e-9;  // of the mean diagonal, added to a Laplacian that has constants in its kernel

}  // namespace

Laplace::Laplace(const Net& net) : net_(net), unknown_(net.vertex_count(), -1) {
  int count = 0;
  for (int v = 0; v < net.vertex_count(); ++v) {
    const int place = place_of(net, v);
    unknown_[v] = place < v ? unknown_[place] : count++;
  }
  area_ = Eigen::VectorXd::Zero(count);
  for (int v = 0; v < net.vertex_count(); ++v) area_[unknown_[v]] += net.vertex_area[v] / net.whole_area;
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < count; ++i) entries.emplace_back(i, i, kRegular);
  for (int side = 0; side < net.side_count(); ++side) {
    if (net.twin[side] > side) continue;  // each edge once
    const int a = unknown_[net.tail[side]], b = unknown_[net.head[side]];
    if (a == b) continue;
    entries.emplace_back(a, a, net.weight[side]);
    entries.emplace_back(b, b, net.weight[side]);
    entries.emplace_back(std::max(a, b), std::min(a, b), -net.weight[side]);
  }
  Eigen::SparseMatrix<double> lower(count, count);
  lower.setFromTriplets(entries.begin(), entries.end());
  factor_.compute(lower, {});
}

Eigen::MatrixXd Laplace::solve(const Eigen::MatrixXd& B) {
  Eigen::MatrixXd b = Eigen::MatrixXd::Zero(area_.size(), B.cols());
  for (int v = 0; v < net_.vertex_count(); ++v) b.row(unknown_[v]) += B.row(v);
  b -= area_ * b.colwise().sum().eval();
  Eigen::MatrixXd x = factor_.solve(b);
  x.rowwise() -= (area_.transpose() * x).eval();
  Eigen::MatrixXd result(B.rows(), B.cols());
  for (int v = 0; v < net_.vertex_count(); ++v) result.row(v) = x.row(unknown_[v]);
  return result;
}

}  // namespace holomorph::turns
