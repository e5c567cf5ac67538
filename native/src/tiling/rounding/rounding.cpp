#include "tiling/rounding/rounding.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "base/task_progress.h"
#include "base/workers.h"
#include "linear/blocks.h"
#include "linear/dense.h"
#include "tiling/poles/meromorphic_form.h"

namespace holomorph::tiling {
namespace {

constexpr double kChange = 0.2;         // relative change of the form that costs 1
constexpr double kRegularGram = 1e-12;  // of the largest diagonal entry, added to keep a Gram matrix definite
constexpr Index kManyColumns = 192,
                kBlockColumns = 32;  // matrices with many columns are multiplied in blocks of columns

// Upper R with R^H R = H.
MatrixXcd root(MatrixXcd H) {
  if (H.rows() == 0) return H;
  H += kRegularGram * H.diagonal().real().maxCoeff() * MatrixXcd::Identity(H.rows(), H.cols());
  return linear::Cholesky(H).upper();
}

// Calls task(begin, size) for blocks of columns, in parallel.
template <class Task>
void for_columns(Index count, Execution& execution, const Task& task) {
  const auto blocks = static_cast<int>((count + kBlockColumns - 1) / kBlockColumns);
  constexpr int kAtATime = 8;
  for (int first = 0; first < blocks; first += kAtATime) {
    execution.report(0);
    run_long_tasks(execution.workers(), std::min(kAtATime, blocks - first), [&](int i) {
      const Index begin = (first + i) * kBlockColumns;
      task(begin, std::min(kBlockColumns, count - begin));
    });
  }
}

// Computes forms^H weights forms; for many columns only the lower half, which the Cholesky factorisation reads.
MatrixXcd gram(const MatrixXcd& forms, const VectorXcd& weights, Execution& execution) {
  const Index count = forms.cols();
  if (count < kManyColumns) return forms.adjoint() * weights.asDiagonal() * forms;
  MatrixXcd H = MatrixXcd::Zero(count, count);
  for_columns(count, execution, [&](Index begin, Index size) {
    const MatrixXcd weighted = weights.asDiagonal() * forms.middleCols(begin, size);
    H.block(begin, begin, count - begin, size).noalias() = forms.rightCols(count - begin).adjoint() * weighted;
  });
  return H;
}

constexpr double kDefects[] = {0.3, 0.1, 0.03, 0.01, 0.003};  // |mu| that costs 1
constexpr int kPhases = 30, kScales = 7;
constexpr std::size_t kWanted = 8;  // roundings that are returned, at most
constexpr int kShortRounds = 3;     // rounds of short steps, each from the best of the last
constexpr int kNearPhases = 7;      // phases around a given one
// Reducing a lattice of more integers as a whole takes more than a few seconds, a time that grows with the fourth
// power. Then it is reduced by blocks, for fewer prices of defects, and fewer phases and scales are tried.
constexpr Index kWhole = 160;
constexpr double kDefectsByBlocks[] = {0.1, 0.01};
constexpr int kPhasesByBlocks = 8, kScalesByBlocks = 3;
// Usual steps of a reduction, and usual number of roundings, for the progress function.
constexpr double kUsualSteps = 10000, kUsualTargets = 1000;
constexpr double kScaleRange = 0.12;                                  // scales of the target from 1 - this to 1 + this
constexpr double kConformal = 5, kEvenness = 0.15, kTolerated = 1.1;  // weights and bound in the rank (Rounding::rank)
// Every rounding flips a small disk around a zero of the form: a flipped sample counts as kFlipped. A rounding with a
// mean of kNoMap or more, or less even than the target by the factor kUneven, is dropped.
constexpr double kFlipped = 10, kNoMap = 2, kUneven = 8;

// Stacks real parts above imaginary ones: the lattice is real.
MatrixXd as_real(const MatrixXcd& rows) {
  MatrixXd result(2 * rows.rows(), rows.cols());
  result << rows.real(), rows.imag();
  return result;
}

double excess(const ArrayXd& lengths) {
  return lengths.size() == 0 ? 1 : std::sqrt(lengths.square().mean()) / std::exp(lengths.log().mean());
}

// Measures the roundings with these integers, and returns the best of them and of a list.
std::vector<Rounding> best_of(const RoundingProblem& p, const std::set<std::vector<std::int64_t>>& integers,
                              std::vector<Rounding> list, Execution& execution, TaskProgress& watch) {
  const std::size_t known = list.size();
  for (const auto& z : integers) list.push_back({Eigen::Map<const linear::IntegerVector>(z.data(), std::ssize(z)), {}});
  run_throwing(execution.workers(), static_cast<int>(integers.size()), [&](int thread, int i) {
    watch(thread);
    Rounding& rounding = list[known + i];
    rounding.y = p.Z * rounding.z.cast<double>().cast<Complex>();
    measure(p, rounding);
  });
  const double most = kUneven * p.target_ratio;
  std::erase_if(list, [&](const Rounding& r) { return !(r.distortion < kNoMap && r.density_ratio < most); });
  std::stable_sort(list.begin(), list.end(), [](const Rounding& a, const Rounding& b) { return a.rank < b.rank; });
  if (list.size() > kWanted) list.resize(kWanted);
  return list;
}

// Returns new integers that differ from those of a rounding by one step, a column of `steps`. They turn the texture no
// further than is allowed, or than the roundings of the list do. Nearest planes leave gaps of sizes, which short
// vectors fill.
std::set<std::vector<std::int64_t>> a_step_away(const RoundingProblem& p, const RoundingOptions& options,
                                                const std::vector<Rounding>& list, const linear::IntegerMatrix& steps,
                                                const std::set<std::vector<std::int64_t>>& known) {
  const VectorXcd weights = mean_weights(p.target_density);
  // The weighted product of the target with the form of z: its argument is the angle by which z turns the texture.
  const Eigen::RowVectorXcd along = ((p.forms * p.target).adjoint() * weights.asDiagonal() * p.forms) * p.Z;
  const Complex back = std::polar(1.0, -options.phase.value_or(0));
  const auto turn = [&](const linear::IntegerVector& z) {
    return std::abs(std::arg(back * (along * z.cast<double>().cast<Complex>()).value()));
  };
  double most = std::numbers::pi;
  if (options.phase && p.kind == uv::Coefficients::complex) {
    most = options.max_turn;
    for (const Rounding& rounding : list) most = std::max(most, turn(rounding.z));
  }
  std::set<std::vector<std::int64_t>> found;
  for (const Rounding& rounding : list) {
    for (Index j = 0; j < steps.cols(); ++j) {
      for (const int sign : {1, -1}) {
        const linear::IntegerVector z = rounding.z + sign * steps.col(j);
        if (turn(z) > most) continue;
        if (std::vector<std::int64_t> own(z.begin(), z.end()); !known.contains(own)) found.insert(std::move(own));
      }
    }
  }
  return found;
}

}  // namespace

constexpr double kSame = 1e-9;  // relative distance up to which points count as the same

Eigen::Vector2d TextureLattice::coordinates(Complex z) const {
  Eigen::Matrix2d A;
  A << a.real(), b.real(), a.imag(), b.imag();
  return A.inverse() * Eigen::Vector2d(z.real(), z.imag());
}

Complex TextureLattice::nearest(Complex z) const {
  const Eigen::Vector2d c = coordinates(z);
  return point(std::round(c[0]), std::round(c[1]));
}

bool TextureLattice::has(Complex z) const { return std::abs(z - nearest(z)) < kSame * std::abs(z); }

double TextureLattice::symmetry() const {
  for (const int part : {3, 2}) {
    const Complex turn = std::polar(1.0, std::numbers::pi / part);
    if (has(turn * a) && has(turn * b)) return std::numbers::pi / part;
  }
  return std::numbers::pi;
}

VectorXcd mean_weights(const ArrayXd& density) {
  const ArrayXd floored = density + uv::kDensityFloor * density.mean();
  return (1 / (floored * static_cast<double>(density.size()))).matrix().cast<Complex>();
}

MatrixXcd defect_metric(const MatrixXcd& defects, const ArrayXd& target_density, Execution& execution) {
  return root(gram(defects, mean_weights(target_density), execution));
}

RoundingMetric::RoundingMetric(const RoundingProblem& problem, Execution& execution)
    : problem_(problem),
      of_change_(root(gram(problem.forms, mean_weights(problem.target_density), execution)) / kChange) {}

MatrixXcd RoundingMetric::rows(double defect) const {
  const Index all = problem_.forms.cols(), l = problem_.defects.cols();
  MatrixXcd rows = MatrixXcd::Zero(all + l, all);
  rows.topRows(all) = of_change_;
  if (l == 0) return rows;
  const MatrixXcd& metric = problem_.defect_metric;
  // Defects as a Gaussian: those of size `defect` cost 1, and those that moving poles repairs are as likely. The
  // inverse covariance is the metric.
  MatrixXcd covariance = defect * defect * linear::inverse(MatrixXcd(metric.adjoint() * metric));
  if (problem_.repairable.size() > 0) covariance += problem_.repairable;
  rows.bottomRightCorner(l, l) = root(linear::inverse(covariance));
  return rows;
}

MatrixXcd product(const MatrixXcd& A, const MatrixXcd& B, Execution& execution) {
  if (B.cols() < kManyColumns) return A * B;
  MatrixXcd result(A.rows(), B.cols());
  for_columns(B.cols(), execution, [&](Index begin, Index size) {
    result.middleCols(begin, size).noalias() = A * B.middleCols(begin, size);
  });
  return result;
}

void measure(const RoundingProblem& p, Rounding& rounding) {
  const ArrayXd density = (p.forms * rounding.y).cwiseAbs2().array();
  rounding.density_ratio = density_ratio(density);
  if (p.defects.cols() > 0) {
    // mu = B / A, and s1 / s2 = (1 + |mu|) / (1 - |mu|).
    const ArrayXd mu = ((p.defects * rounding.y.tail(p.defects.cols())).cwiseAbs2().array() / density).sqrt();
    const ArrayXd K = (mu < 1).select((1 + mu) / (1 - mu), kFlipped).min(kFlipped);
    rounding.distortion = K.mean();
  }
  rounding.rank = kConformal * (rounding.distortion - 1) +
                  kEvenness * std::max(0.0, std::log(rounding.density_ratio / (kTolerated * p.target_ratio))) +
                  p.size_weight * std::abs(std::log(median(density) / p.median_density));
}

RoundingSearch::RoundingSearch(const RoundingProblem& problem, const RoundingOptions& options, Execution& execution)
    : problem_(problem), options_(options), execution_(execution) {
  std::vector<double> prices(std::begin(kDefects), std::end(kDefects));
  if (!is_whole()) prices.assign(std::begin(kDefectsByBlocks), std::end(kDefectsByBlocks));
  if (problem.defects.cols() == 0) prices.resize(1);
  record_.integers = static_cast<int>(problem.Z.cols());
  const RoundingMetric metric(problem, execution);
  for (const double price : prices) weighted_.push_back(weighted(metric.rows(price)));
}

bool RoundingSearch::is_whole() const { return problem_.Z.cols() <= kWhole; }

// The rotations of the texture that are tried: all up to the lattice's symmetry, or those near a given one.
std::vector<double> RoundingSearch::phases() const {
  if (problem_.kind == uv::Coefficients::real)
    return {options_.phase && std::cos(*options_.phase) < 0 ? std::numbers::pi
                                                            : 0};  // u runs along boundaries either way
  std::vector<double> phases;
  const int count = is_whole() ? kPhases : kPhasesByBlocks;
  for (int i = 0; !options_.phase && i < count; ++i) phases.push_back(problem_.lattice.symmetry() * i / count);
  for (int i = 0; options_.phase && i < kNearPhases; ++i)
    phases.push_back(*options_.phase + options_.max_turn * (2.0 * i / (kNearPhases - 1) - 1));
  return phases;
}

int RoundingSearch::scales() const { return is_whole() ? kScales : kScalesByBlocks; }

RoundingSearch::Weighted RoundingSearch::weighted(const MatrixXcd& rows) {
  const VectorXcd& target = problem_.target;
  const MatrixXd B = as_real(product(rows, problem_.Z, execution_));
  Weighted result{rows, MatrixXd(B.rows(), 2), {}};
  TaskProgress watch(execution_, kUsualSteps, static_cast<double>(B.cols()));
  if (is_whole()) {
    result.reduced = linear::reduce(B, linear::kDelta, [&] { watch(0); });
  } else {
    result.points << as_real(rows * target), as_real(rows * (Complex(0, 1) * target));
    result.reduced = linear::reduce_by_blocks(B, result.points, execution_);
  }
  record_.blocks = result.reduced.blocks;
  record_.steps += result.reduced.steps;
  record_.excess = std::max(record_.excess, excess(result.reduced.R.diagonal().array()));
  return result;
}

linear::IntegerVector RoundingSearch::nearest(const Weighted& weighted, Complex by) const {
  const VectorXcd y = problem_.target * by;
  return linear::nearest_plane(weighted.reduced,
                               is_whole() ? VectorXd(as_real(weighted.rows * y))
                                          : VectorXd(weighted.points * Eigen::Vector2d(by.real(), by.imag())));
}

std::vector<Rounding> RoundingSearch::best() const {
  // The target at the wanted number of tiles.
  const double scale = std::sqrt(problem_.median_density / median(problem_.target_density));
  const std::vector<double> turns = phases();
  const int scales = this->scales();
  TaskProgress watch(execution_, kUsualTargets, static_cast<double>(problem_.Z.size()));
  std::set<std::vector<std::int64_t>> found;
  for (const Weighted& each : weighted_) {
    std::vector<linear::IntegerVector> list(turns.size() * scales);
    run_throwing(execution_.workers(), static_cast<int>(list.size()), [&](int thread, int i) {
      watch(thread);
      const double size = scale * (1 + kScaleRange * (2.0 * (i % scales) / (scales - 1) - 1));
      list[i] = nearest(each, std::polar(size, turns[i / scales]));
    });
    for (const linear::IntegerVector& z : list) found.emplace(z.begin(), z.end());
  }
  std::vector<Rounding> list = best_of(problem_, found, {}, execution_, watch);
  for (int step = 0; step < kShortRounds && options_.steps && is_whole(); ++step) {
    const auto further = a_step_away(problem_, options_, list, weighted_.front().reduced.transform, found);
    found.insert(further.begin(), further.end());
    list = best_of(problem_, further, std::move(list), execution_, watch);
  }
  return list;
}

}  // namespace holomorph::tiling
