#include "tiling/rounding/rounding.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "base/chunks.h"
#include "tiling/poles/meromorphic_form.h"

namespace holomorph::tiling {
namespace {

constexpr double kChange = 0.2;                               // relative change of the form that costs 1
constexpr double kDefects[] = {0.3, 0.1, 0.03, 0.01, 0.003};  // |mu| that costs 1
constexpr int kPhases = 30, kScales = 7;
constexpr std::size_t kWanted = 8;  // roundings at most
constexpr int kSteps = 3;           // rounds, each from the best of the last
constexpr int kNearPhases = 7;      // around a phase that is given
constexpr double kScaleRange = 0.12;
constexpr double kSame = 1e-9;      // relative distance of points of a lattice that are one
constexpr double kRegular = 1e-12;  // of the largest diagonal entry: keeps a Gram matrix definite in spite of rounding
constexpr double kConformal = 5, kEvenness = 0.15, kTolerated = 1.1;  // terms and bounds for the rank
// Around a zero of the form every rounding flips a small disk: a sample there counts so much. A rounding with a larger
// mean than the next, or so much less even than the target, is none.
constexpr double kFlipped = 10, kNoMap = 2, kUneven = 8;

// Complex rows as real ones.
MatrixXd as_real(const MatrixXcd& rows) {
  MatrixXd result(2 * rows.rows(), rows.cols());
  result << rows.real(), rows.imag();
  return result;
}

// Upper R with R^H R = H.
MatrixXcd root(MatrixXcd H) {
  if (H.rows() == 0) return H;
  H += kRegular * H.diagonal().real().maxCoeff() * MatrixXcd::Identity(H.rows(), H.cols());
  return Eigen::LLT<MatrixXcd>(H).matrixU();
}

// 1 / |theta_0|^2, for means over the samples.
VectorXcd mean_weights(const ArrayXd& density) {
  const ArrayXd floored = density + uv::kDensityFloor * density.mean();
  return (1 / (floored * static_cast<double>(density.size()))).matrix().cast<Complex>();
}

// Rows that measure y near the target: its change, and its defects at a price of `defect`.
MatrixXcd measure_rows(const RoundingProblem& p, const VectorXcd& weights, double defect) {
  const Index all = p.forms.cols(), l = p.defects.cols();
  MatrixXcd rows = MatrixXcd::Zero(all + l, all);
  rows.topRows(all) = root(p.forms.adjoint() * weights.asDiagonal() * p.forms) / kChange;
  if (l == 0) return rows;
  const MatrixXcd metric = defect_metric(p);
  MatrixXcd covariance = defect * defect * (metric.adjoint() * metric).inverse();
  if (p.repairable.size() > 0) covariance += p.repairable;
  rows.bottomRightCorner(l, l) = root(covariance.inverse());
  return rows;
}

// The rotations of the texture that are tried.
std::vector<double> phases_of(const RoundingProblem& p, const RoundingOptions& options) {
  if (p.kind == uv::Coefficients::real)
    return {options.phase && std::cos(*options.phase) < 0 ? std::numbers::pi
                                                          : 0};  // u runs along boundaries either way
  std::vector<double> phases;
  for (int i = 0; !options.phase && i < kPhases; ++i) phases.push_back(p.lattice.symmetry() * i / kPhases);
  for (int i = 0; options.phase && i < kNearPhases; ++i)
    phases.push_back(*options.phase + options.max_turn * (2.0 * i / (kNearPhases - 1) - 1));
  return phases;
}

// The best of a list and of those with these integers.
std::vector<Rounding> best_of(const RoundingProblem& p, const std::set<std::vector<std::int64_t>>& integers,
                              std::vector<Rounding> list, Execution& execution) {
  const std::size_t known = list.size();
  for (const auto& z : integers)
    list.push_back({Eigen::Map<const lattice::IntegerVector>(z.data(), std::ssize(z)), {}});
  run_throwing(execution.workers(), static_cast<int>(integers.size()), [&](int i) {
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

// Integers that differ from those of a rounding by one of the steps, which are columns, are not known, and turn the
// texture no further than is allowed or the others do.
std::set<std::vector<std::int64_t>> a_step_away(const RoundingProblem& p, const RoundingOptions& options,
                                                const std::vector<Rounding>& list, const lattice::IntegerMatrix& steps,
                                                const std::set<std::vector<std::int64_t>>& known) {
  const VectorXcd weights = mean_weights(p.target_density);
  const Eigen::RowVectorXcd along = ((p.forms * p.target).adjoint() * weights.asDiagonal() * p.forms) * p.Z;
  const Complex back = std::polar(1.0, -options.phase.value_or(0));
  const auto turn = [&](const lattice::IntegerVector& z) {
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
        const lattice::IntegerVector z = rounding.z + sign * steps.col(j);
        if (turn(z) > most) continue;
        if (std::vector<std::int64_t> own(z.begin(), z.end()); !known.contains(own)) found.insert(std::move(own));
      }
    }
  }
  return found;
}

}  // namespace

Eigen::Vector2d TextureLattice::coordinates(Complex z) const {
  Eigen::Matrix2d A;
  A << a.real(), b.real(), a.imag(), b.imag();
  return A.inverse() * Eigen::Vector2d(z.real(), z.imag());
}

Complex TextureLattice::nearest(Complex z) const {
  const Eigen::Vector2d c = coordinates(z);
  return point(std::round(c[0]), std::round(c[1]));
}

MatrixXcd defect_metric(const RoundingProblem& p) {
  return root(p.defects.adjoint() * mean_weights(p.target_density).asDiagonal() * p.defects);
}

double TextureLattice::symmetry() const {
  for (const int part : {3, 2}) {
    const Complex turn = std::polar(1.0, std::numbers::pi / part);
    const auto is_kept = [&](Complex z) { return std::abs(turn * z - nearest(turn * z)) < kSame * std::abs(z); };
    if (is_kept(a) && is_kept(b)) return std::numbers::pi / part;
  }
  return std::numbers::pi;
}

void measure(const RoundingProblem& p, Rounding& rounding) {
  const ArrayXd density = (p.forms * rounding.y).cwiseAbs2().array();
  rounding.density_ratio = density_ratio(density);
  if (p.defects.cols() > 0) {
    const ArrayXd mu = ((p.defects * rounding.y.tail(p.defects.cols())).cwiseAbs2().array() / density).sqrt();
    const ArrayXd K = (mu < 1).select((1 + mu) / (1 - mu), kFlipped).min(kFlipped);
    rounding.distortion = K.mean();
  }
  rounding.rank = kConformal * (rounding.distortion - 1) +
                  kEvenness * std::max(0.0, std::log(rounding.density_ratio / (kTolerated * p.target_ratio))) +
                  p.size_weight * std::abs(std::log(median(density) / p.median_density));
}

std::vector<Rounding> roundings(const RoundingProblem& p, const RoundingOptions& options, Execution& execution) {
  const double scale = std::sqrt(p.median_density / median(p.target_density));
  const VectorXcd weights = mean_weights(p.target_density);
  const std::vector<double> phases = phases_of(p, options);
  std::set<std::vector<std::int64_t>> found;
  lattice::IntegerMatrix steps;
  for (std::size_t d = 0; d < std::size(kDefects); ++d) {
    execution.report(static_cast<double>(d) / std::size(kDefects));
    if (d > 0 && p.defects.cols() == 0) break;
    const MatrixXcd rows = measure_rows(p, weights, kDefects[d]);
    const lattice::ReducedBasis reduced = lattice::reduce(as_real(rows * p.Z));
    if (options.steps && d == 0) steps = reduced.transform;
    std::vector<lattice::IntegerVector> nearest(phases.size() * kScales);
    run_throwing(execution.workers(), static_cast<int>(nearest.size()), [&](int i) {
      const double size = scale * (1 + kScaleRange * (2.0 * (i % kScales) / (kScales - 1) - 1));
      const VectorXcd y = p.target * std::polar(size, phases[i / kScales]);
      nearest[i] = lattice::nearest_plane(reduced, as_real(rows * y));
    });
    for (const lattice::IntegerVector& z : nearest) found.emplace(z.begin(), z.end());
  }
  std::vector<Rounding> list = best_of(p, found, {}, execution);
  for (int step = 0; step < kSteps && steps.size() > 0; ++step) {
    const auto further = a_step_away(p, options, list, steps, found);
    found.insert(further.begin(), further.end());
    list = best_of(p, further, std::move(list), execution);
  }
  return list;
}

}  // namespace holomorph::tiling
