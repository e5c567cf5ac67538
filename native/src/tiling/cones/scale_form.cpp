#include "tiling/cones/scale_form.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace holomorph::tiling {

using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double kRegular = 1e-9;  // of the mean diagonal, added to a Laplacian that has constants in its kernel

constexpr double kTwoPi = 2 * std::numbers::pi;
constexpr std::size_t kSolvedAtOnce = 64;  // candidates

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

ScaleForm::ScaleForm(const Net& net, int k)
    : net_(net), unit_(kTwoPi / k), laplace_(net), loops_(dual_loops(net)), weights_(net.vertex_count()) {
  for (int v = 0; v < net.vertex_count(); ++v) weights_[v] = net.vertex_area[v] / net.whole_area;
  VectorXd defect = VectorXd::Zero(net.vertex_count());
  double sum = 0;
  for (int v = 0; v < net.vertex_count(); ++v) {
    if (net.first[v] < 0) continue;
    defect[place_of(net, v)] += net.defect[v];
    sum += net.defect[v];
  }
  total_ = static_cast<int>(std::lround(sum / unit_));
  u0_ = laplace_.solve(-defect).col(0);
  constant_ = u0_.cwiseAbs2().dot(weights_);
  response0_ = laplace_.solve(weights_.cwiseProduct(u0_)).col(0);
  response_.resize(net.vertex_count());
  flux_of_.resize(net.vertex_count());
  turning_ = fluxes(u0_).col(0);
  for (std::size_t l = 0; l < loops_.size(); ++l) {
    for (const int side : loops_[l]) turning_[static_cast<Eigen::Index>(l)] += net.transport[side];
  }
}

MatrixXd ScaleForm::fluxes(const MatrixXd& functions) const {
  MatrixXd result = MatrixXd::Zero(std::ssize(loops_), functions.cols());
  for (Eigen::Index l = 0; l < result.rows(); ++l) {
    for (const int side : loops_[l])
      result.row(l) += net_.weight[side] * (functions.row(net_.head[side]) - functions.row(net_.tail[side]));
  }
  return result;
}

void ScaleForm::respond(const std::vector<int>& places, const std::function<void()>& report) {
  std::vector<int> fresh;
  for (const int place : places) {
    if (response_[place].size() == 0) fresh.push_back(place);
  }
  for (std::size_t first = 0; first < fresh.size(); first += kSolvedAtOnce) {
    report();
    const auto count = static_cast<Eigen::Index>(std::min(kSolvedAtOnce, fresh.size() - first));
    MatrixXd B = MatrixXd::Zero(net_.vertex_count(), count);
    for (Eigen::Index i = 0; i < count; ++i) B(fresh[first + i], i) = unit_;
    const MatrixXd G = laplace_.solve(B), response = laplace_.solve(weights_.asDiagonal() * G), flux = fluxes(G);
    for (Eigen::Index i = 0; i < count; ++i) {
      response_[fresh[first + i]] = unit_ * response.col(i);
      flux_of_[fresh[first + i]] = flux.col(i);
    }
  }
}

void ScaleForm::take(const std::vector<int>& places, const std::function<void()>& report) {
  respond(places, report);
  const auto count = std::ssize(places);
  Q_.resize(count, count);
  b_.resize(count);
  flux_.resize(std::ssize(loops_), count);
  for (Eigen::Index j = 0; j < count; ++j) {
    const VectorXd& column = response_[places[j]];
    for (Eigen::Index i = 0; i < count; ++i) Q_(i, j) = column[places[i]];
    b_[j] = -unit_ * response0_[places[j]];
    flux_.col(j) = flux_of_[places[j]];
  }
  Q_ = (0.5 * (Q_ + Q_.transpose())).eval();
}

}  // namespace holomorph::tiling
