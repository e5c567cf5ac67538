#include "tiling/cones/scale_form.h"

#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/constants.h"
#include "mesh/triangle_geometry.h"

namespace holomorph::tiling {

using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

using mesh::difference;
using mesh::dot;
using mesh::Point;

constexpr double kScale = 40;                           // of the weight, relative to the lowest modes of the field
constexpr double kLeastWeight = 0.1, kMostWeight = 10;  // weights of edges between the limits, for their inverses
constexpr double kCancels = 0.3;  // of a side's length: two lines of a triangle that are no k-th turn apart
constexpr double kUpright = 0.7;  // cosine
constexpr int kPulls = 8;         // steps, each with the same matrix

// The field at the triangles beside lines, 0 at others: of two lines that disagree the longer one counts.
std::vector<Complex> beside_lines(const Net& net, const std::vector<Point>& points, int k, const Along& along) {
  std::vector<int> sides;
  for (int side = 0; side < net.side_count(); ++side) {
    if (net.is_line[side] && net.area[side / 3] > 0) sides.push_back(side);
  }
  const auto length = [&](int side) { return std::abs(net.along[side]); };
  std::stable_sort(sides.begin(), sides.end(), [&](int a, int b) { return length(a) < length(b); });
  std::vector<Complex> field(net.triangle_count(), 0.0);
  for (const int side : sides) {
    Complex own = std::polar(1.0, k * std::arg(net.along[side]));
    if (k == 2) {  // the line is one along u, or one along v
      const double upwards = std::abs(dot(difference(points[net.head[side]], points[net.tail[side]]), along.vector));
      if ((upwards > kUpright * length(side)) != along.is_of_u) own = -own;
    }
    const Complex sum = field[side / 3] + own * length(side);
    field[side / 3] = std::abs(sum) > kCancels * length(side) ? sum : own * length(side);
  }
  for (Complex& z : field) {
    if (z != 0.0) z /= std::abs(z);
  }
  return field;
}

// The angle, less the nearest multiple of a k-th turn.
double within_turn(double angle, int k) {
  const double unit = kTwoPi / k;
  return angle - unit * std::round(angle / unit);
}

constexpr double kRegularLaplacian =
    1e-9;  // of the mean diagonal, added to a Laplacian that has constants in its kernel

constexpr std::size_t kSolvedAtOnce = 32;  // candidates

}  // namespace

ConePlaces::ConePlaces(const mesh::Surface& surface, const Net& net, std::vector<int> patch)
    : points_(surface.polygons.vertices), net_(net), patch_(std::move(patch)), have_patches_(!patch_.empty()) {
  if (!have_patches_) patch_.assign(net.vertex_count(), 0);
}

bool ConePlaces::is_place(int v) const { return net_.first[v] >= 0 && place_of(net_, v) == v && patch_[v] >= 0; }

double ConePlaces::squared_distance(int v, int w) const {
  double sum = 0;
  for (int i = 0; i < 3; ++i) sum += (points_[v][i] - points_[w][i]) * (points_[v][i] - points_[w][i]);
  return sum;
}

std::vector<int> ConePlaces::within(int v, double squared) const {
  std::vector<int> within;
  for (int w = 0; w < net_.vertex_count(); ++w) {
    if (is_place(w) && squared_distance(v, w) < squared) within.push_back(w);
  }
  return within;
}

std::vector<std::vector<std::size_t>> ConePlaces::near(const std::vector<int>& vertices, double squared) const {
  std::vector<std::vector<std::size_t>> near(vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    for (std::size_t j = 0; j < vertices.size(); ++j) {
      if (i != j && !is_hole(vertices[i]) && !is_hole(vertices[j]) &&
          squared_distance(vertices[i], vertices[j]) < squared)
        near[i].push_back(j);
    }
  }
  return near;
}

Level level_directions(const Net& net, const std::vector<Point>& points, const Along& along) {
  const Point& up = along.vector;
  Level result{std::vector<Complex>(net.triangle_count(), 1.0), std::vector<double>(net.triangle_count(), 0.0)};
  for (int t = 0; t < net.triangle_count(); ++t) {
    if (!(net.area[t] > 0)) continue;
    // up . x and up . y by the two sides from corner 0, of which the first is along x.
    const Point first = difference(points[net.head[3 * t]], points[net.tail[3 * t]]);
    const Point last = difference(points[net.tail[3 * t + 2]], points[net.tail[3 * t]]);
    const Complex apex = -net.along[3 * t + 2];
    const double x = dot(first, up) / net.along[3 * t].real();
    const double y = (dot(last, up) - apex.real() * x) / apex.imag();
    const Complex upwards(x, y);
    result.steepness[t] = std::min(std::norm(upwards), 1.0);
    if (std::abs(upwards) > 1e-9)
      result.direction[t] = (along.is_of_u ? Complex(1) : Complex(0, -1)) * upwards / std::abs(upwards);
  }
  return result;
}

double dual_weight(const Net& net, int side) { return 1 / std::clamp(net.weight[side], kLeastWeight, kMostWeight); }

std::vector<Complex> level_field(const Net& net, const std::vector<Point>& points, int k, const Along& along,
                                 double weight) {
  const int count = net.triangle_count();
  const Level level = level_directions(net, points, along);
  const std::vector<Complex> held = beside_lines(net, points, k, along);
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::MatrixXd b = Eigen::MatrixXd::Zero(2 * count, 1);
  const auto add = [&](int row, int column, Complex value) {  // a complex entry as a real block, the lower half
    const double block[2][2] = {{value.real(), -value.imag()}, {value.imag(), value.real()}};
    for (int i = 0; i < 2; ++i) {
      for (int j = 0; j < 2; ++j) {
        if (2 * row + i >= 2 * column + j) entries.emplace_back(2 * row + i, 2 * column + j, block[i][j]);
      }
    }
  };
  for (int t = 0; t < count; ++t) {
    if (held[t] != 0.0) {
      add(t, t, kHeld);
      b(2 * t, 0) = kHeld * held[t].real();
      b(2 * t + 1, 0) = kHeld * held[t].imag();
      continue;
    }
    const double pull = weight * kScale / count * (net.area[t] / net.whole_area * count) * level.steepness[t];
    add(t, t, pull + 1e-9);
    const Complex wanted = pull * std::pow(level.direction[t], k);
    b(2 * t, 0) = wanted.real();
    b(2 * t + 1, 0) = wanted.imag();
  }
  for (int side = 0; side < net.side_count(); ++side) {
    const int back = net.twin[side];
    if (back < side) continue;  // each inner edge once
    const int f = side / 3, g = back / 3;
    if (f == g) continue;
    const double w = dual_weight(net, side);
    const Complex carried = std::polar(1.0, k * net.transport[side]);  // z_g is to be carried * z_f
    add(f, f, w);
    add(g, g, w);
    if (f < g)
      add(g, f, -w * carried);
    else
      add(f, g, -w * std::conj(carried));
  }
  Eigen::SparseMatrix<double> lower(2 * count, 2 * count);
  lower.setFromTriplets(entries.begin(), entries.end());
  solver::SparseCholesky factor;
  factor.compute(lower, {});
  const Eigen::MatrixXd x = factor.solve(b);
  std::vector<Complex> field(count);
  for (int t = 0; t < count; ++t) {
    const Complex z(x(2 * t, 0), x(2 * t + 1, 0));
    field[t] = held[t] != 0.0 ? held[t] : std::abs(z) > 0 ? z / std::abs(z) : Complex(1);
  }
  return field;
}

void pull_level(const Net& net, const std::vector<Point>& points, int k, const Along& along, double weight,
                std::vector<double>& angle) {
  const int count = net.triangle_count();
  const Level level = level_directions(net, points, along);
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd pull(count);
  for (int t = 0; t < count; ++t) {
    pull[t] = weight * kScale * net.area[t] / net.whole_area * level.steepness[t];
    entries.emplace_back(t, t, pull[t] + 1e-9);
  }
  for (int side = 0; side < net.side_count(); ++side) {
    const int f = side / 3, g = net.twin[side] / 3;
    if (net.twin[side] < side || f == g) continue;
    const double w = dual_weight(net, side);
    entries.emplace_back(f, f, w);
    entries.emplace_back(g, g, w);
    entries.emplace_back(std::max(f, g), std::min(f, g), -w);
  }
  Eigen::SparseMatrix<double> lower(count, count);
  lower.setFromTriplets(entries.begin(), entries.end());
  solver::SparseCholesky factor;
  factor.compute(lower, {});
  Eigen::MatrixXd delta = Eigen::MatrixXd::Zero(count, 1);
  for (int step = 0; step < kPulls; ++step) {
    Eigen::MatrixXd b(count, 1);
    for (int t = 0; t < count; ++t) {
      const double off = k * (angle[t] + delta(t, 0) - std::arg(level.direction[t]));
      b(t, 0) = pull[t] * (delta(t, 0) - std::sin(off) / k);
    }
    delta = factor.solve(b);
  }
  for (int t = 0; t < count; ++t) angle[t] += delta(t, 0);
}

std::vector<int> cones_of_field(const Net& net, const std::vector<Complex>& field, int k) {
  std::vector<double> turned(net.vertex_count(), 0.0);
  for (int v = 0; v < net.vertex_count(); ++v) {
    if (net.first[v] >= 0) turned[v] = net.defect[v];
  }
  for (int side = 0; side < net.side_count(); ++side) {
    const int back = net.twin[side];
    if (back >= 0) {
      const Complex carried = field[side / 3] * std::polar(1.0, k * net.transport[side]);
      turned[net.head[side]] += std::arg(field[back / 3] * std::conj(carried)) / k;
    } else if (net.hole[net.tail[side]] < 0) {  // what the boundary turns against the field
      const double beside = within_turn(std::arg(net.along[side]) - std::arg(field[side / 3]) / k, k);
      turned[net.tail[side]] -= beside;
      turned[net.head[side]] += beside;
    }
  }
  std::vector<double> sums(net.vertex_count(), 0.0);
  for (int v = 0; v < net.vertex_count(); ++v) sums[net.hole[v] < 0 ? v : net.hole[v]] += turned[v];
  std::vector<int> missing(net.vertex_count(), 0);
  for (int v = 0; v < net.vertex_count(); ++v) missing[v] = static_cast<int>(std::lround(k * sums[v] / kTwoPi));
  return missing;
}

Laplace::Laplace(const Net& net) : net_(net), unknown_(net.vertex_count(), -1) {
  int count = 0;
  for (int v = 0; v < net.vertex_count(); ++v) {
    const int place = place_of(net, v);
    unknown_[v] = place < v ? unknown_[place] : count++;
  }
  area_ = Eigen::VectorXd::Zero(count);
  for (int v = 0; v < net.vertex_count(); ++v) area_[unknown_[v]] += net.vertex_area[v] / net.whole_area;
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < count; ++i) entries.emplace_back(i, i, kRegularLaplacian);
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
