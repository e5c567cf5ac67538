#include "tiling/poles/pole_objective.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/errors.h"
#include "linear/dense.h"
#include "tiling/inversion/abel_jacobi.h"
#include "uv/density_objective.h"

namespace holomorph::tiling {
namespace {

using Eigen::ArrayXf;
using Eigen::MatrixXf;
using Eigen::VectorXf;

// How uneven the density of a form is, for a search that asks often: uv::DensityObjective in single precision.

// Variance of log(q / mean q + floor), q = |A|^2, to some 1e-6 of it.
class DensityObjectiveF32 {
 public:
  /// @param parts #samples x #unknowns: A are their combinations
  DensityObjectiveF32(const Eigen::MatrixXcf& parts, uv::Coefficients kind);

  void set_floor(double floor) { floor_ = static_cast<float>(floor); }
  double operator()(const VectorXd& x, VectorXd& gradient) const;

  /// Minimises it from `x`, whose scale is free; the first step knows the curvature there.
  /// @param tick called for each value; it may throw
  void descend(VectorXd& x, int most_steps, const std::function<void()>& tick) const;

  /// q on the samples.
  ArrayXd density(const VectorXd& x) const;

 private:
  MatrixXd inverse_curvature(const VectorXd& x) const;

  Eigen::MatrixXf M_;  // real parts of A above imaginary ones, of each unknown
  float floor_ = 0;
};

// Near a zero of the form the logarithm is too curved for its derivative to be of use. There densities count as this
// part of their geometric mean.
constexpr float kBent = 0.1F;
constexpr double kDamping = 0.01;                      // of the mean curvature
constexpr double kProgress = 1e-5, kShortest = 0.001;  // smaller progress and shorter steps are rounding

ArrayXf squares(const VectorXf& A) {
  const Index count = A.size() / 2;
  return A.head(count).array().square() + A.tail(count).array().square();
}

DensityObjectiveF32::DensityObjectiveF32(const Eigen::MatrixXcf& parts, uv::Coefficients kind)
    : M_(2 * parts.rows(), (kind == uv::Coefficients::real ? 1 : 2) * parts.cols()) {
  M_.leftCols(parts.cols()) << parts.real(), parts.imag();
  if (kind == uv::Coefficients::complex) M_.rightCols(parts.cols()) << -parts.imag(), parts.real();
}

double DensityObjectiveF32::operator()(const VectorXd& x, VectorXd& gradient) const {
  VectorXf A = M_ * x.cast<float>();
  const Index count = A.size() / 2;
  const ArrayXf q = squares(A);
  const float mean = q.mean();
  ArrayXf deviation = (q / mean + floor_).log();
  deviation -= deviation.mean();
  const ArrayXf inverse = 1 / (q + floor_ * mean);
  // The mean depends on all unknowns: this is its part, the same for all samples.
  const float through_mean = -2 * (deviation * q * inverse).mean() / mean;
  const ArrayXf by_q = (2 * deviation * inverse + through_mean) * (2 / static_cast<float>(count));
  A.head(count).array() *= by_q;
  A.tail(count).array() *= by_q;
  gradient = (M_.transpose() * A).cast<double>();
  return deviation.square().mean();
}

void DensityObjectiveF32::descend(VectorXd& x, int most_steps, const std::function<void()>& tick) const {
  uv::minimise(
      [&](const VectorXd& at, VectorXd& gradient) {
        tick();
        return (*this)(at, gradient);
      },
      x, {.most_steps = most_steps, .progress = kProgress, .shortest = kShortest}, inverse_curvature(x));
  x.normalize();
}

ArrayXd DensityObjectiveF32::density(const VectorXd& x) const { return squares(M_ * x.cast<float>()).cast<double>(); }

// The inverse Hessian of Gauss and Newton: it has first derivatives of the logarithms alone.
MatrixXd DensityObjectiveF32::inverse_curvature(const VectorXd& x) const {
  const VectorXf A = M_ * x.cast<float>();
  const Index count = A.size() / 2;
  const ArrayXf q = squares(A);
  const float mean = q.mean(), middle = mean * std::exp((q / mean + floor_).log().mean());
  const ArrayXf inverse = 2 / (q + kBent * middle);
  MatrixXf J = (inverse * A.head(count).array()).matrix().asDiagonal() * M_.topRows(count);
  J += (inverse * A.tail(count).array()).matrix().asDiagonal() * M_.bottomRows(count);
  J.rowwise() -= J.colwise().mean().eval();
  MatrixXf H = MatrixXf::Zero(J.cols(), J.cols());
  H.selfadjointView<Eigen::Lower>().rankUpdate(J.transpose(), 2 / static_cast<float>(count));
  MatrixXd C = H.cast<double>();
  C.diagonal().array() += kDamping * C.diagonal().mean() + std::numeric_limits<double>::min();
  return linear::Cholesky(C).inverse();
}

}  // namespace

constexpr double kWeight = 0.06;  // of the Jacobian's term, against the variance
constexpr double kEnough = 0.4;   // singular value at which the term is small
// Least square of a singular value, relative to that: the term stays finite where no pole moves some part of t.
constexpr double kLeastSquare = 6.25e-9;
constexpr int kSteps = 25;      // at most, for the minimiser
constexpr int kManyForms = 20;  // from this number on
// With many forms, all coefficients are fitted seldom: these are steps times forms, as the cost of one grows with them.
constexpr int kStepsTimesForms = 6400, kMostSteps = 100;

PoleObjective::PoleObjective(GreensFunctions& greens, uv::Coefficients kind, int every)
    : greens_(greens),
      kind_(kind),
      every_(every),
      theta_(greens.basis().holomorphic().M(Eigen::seq(0, Eigen::last, every), Eigen::all)) {
  if (greens.basis().has_jacobian()) jacobian_.emplace(greens.basis());
}

void PoleObjective::prepare(const std::vector<int>& vertices, Index poles, Execution& execution) {
  greens_.solve_at(vertices, execution);
  if (!has_jacobian(poles)) return;
  std::vector<int> missing = vertices;
  std::erase_if(missing, [&](int v) { return tau_.contains(v); });
  const Jacobian& jacobian = held(jacobian_);
  const MatrixXcd tau = jacobian.tau(jacobian.triangles_at(missing));
  for (std::size_t i = 0; i < missing.size(); ++i) tau_.emplace(missing[i], tau.col(static_cast<Index>(i)));
}

bool PoleObjective::has_many_forms() const { return theta_.cols() >= kManyForms; }

// With fewer poles than forms the Jacobian has no full rank, wherever they are.
bool PoleObjective::has_jacobian(Index poles) const { return jacobian_ && poles >= theta_.cols(); }

void PoleObjective::optimise(MeromorphicForm& form, const std::vector<double>& floors, const Tick& tick) const {
  if (!has_many_forms()) return descend_quickly(theta_, form, floors, tick);
  // sum_j c_j theta_j stands for all theta_j, with one coefficient that scales and turns it.
  const VectorXcd c = form.coefficients;
  form.coefficients = VectorXcd::Ones(1);
  descend_quickly(theta_ * c, form, floors, tick);
  form.coefficients = form.coefficients[0] * c;
}

void PoleObjective::fit(MeromorphicForm& form, const std::vector<double>& floors, const Tick& tick) const {
  const auto forms = static_cast<int>(theta_.cols());
  const int steps = has_many_forms() ? std::clamp(kStepsTimesForms / forms, kSteps, kMostSteps) : kSteps;
  descend(theta_, form, floors, steps, tick);
}

void PoleObjective::descend(const MatrixXcd& forms, MeromorphicForm& form, const std::vector<double>& floors, int steps,
                            const Tick& tick) const {
  const uv::SampledParts parts{columns(forms, form.poles), {}};
  VectorXd x = uv::as_unknowns(unknowns(form), kind_);
  ArrayXd density;
  for (const double floor : floors) {
    density = (parts.M * unknowns(form)).cwiseAbs2().array();
    // The floor is relative to the median, that of the minimiser to the mean.
    uv::descend(parts, kind_, x, {floor * median(density) / density.mean()}, steps, tick);
    set(uv::as_complex(x, kind_), form);
  }
  density = (parts.M * unknowns(form)).cwiseAbs2().array();
  const MatrixXcd metric = jacobian_metric(density, form.residues.size());
  form.objective = unevenness(density) + jacobian_term(form.poles, form.residues, metric);
}

void PoleObjective::descend_quickly(const MatrixXcd& forms, MeromorphicForm& form, const std::vector<double>& floors,
                                    const Tick& tick) const {
  DensityObjectiveF32 variance(columns(forms, form.poles).cast<std::complex<float>>(), kind_);
  VectorXd x = uv::as_unknowns(unknowns(form), kind_);
  x.normalize();
  ArrayXd density = variance.density(x);
  for (const double floor : floors) {
    variance.set_floor(floor * median(density) / density.mean());
    variance.descend(x, kSteps, tick);
    density = variance.density(x);
  }
  set(uv::as_complex(x, kind_), form);
  const MatrixXcd metric = jacobian_metric(density, form.residues.size());
  form.objective = unevenness(density) + jacobian_term(form.poles, form.residues, metric);
}

VectorXcd PoleObjective::samples_of(const MeromorphicForm& form) const {
  return columns(theta_, form.poles) * unknowns(form);
}

// The columns of `forms`, which stand for the theta_j, and those of the poles.
MatrixXcd PoleObjective::columns(const MatrixXcd& forms, const std::vector<int>& vertices) const {
  const MatrixXcd poles = greens_.pole_forms(vertices, every_);
  MatrixXcd all(theta_.rows(), forms.cols() + poles.cols());
  all << forms, poles;
  return all;
}

VectorXcd PoleObjective::unknowns(const MeromorphicForm& form) const {
  const Index free = std::max<Index>(0, form.residues.size() - (greens_.basis().closed() ? 1 : 0));
  VectorXcd x(form.coefficients.size() + free);
  x << form.coefficients, form.residues.head(free);
  return x;
}

void PoleObjective::set(const VectorXcd& x, MeromorphicForm& form) const {
  const Index n = form.coefficients.size(), free = x.size() - n;
  form.coefficients = x.head(n);
  form.residues.head(free) = x.tail(free);
  if (form.residues.size() > free) form.residues[free] = -x.tail(free).sum();
}

MatrixXcd PoleObjective::jacobian_metric(const ArrayXd& density, Index poles) const {
  if (!has_jacobian(poles)) return {};
  return linear::Cholesky(weighted_gram(theta_, density)).upper() * std::sqrt(greens_.basis().area());
}

// kWeight mean log(1 + (kEnough / sigma)^2) over the singular values of [r_i tau_i] in the weighted Gram matrix.
double PoleObjective::jacobian_term(const std::vector<int>& vertices, const VectorXcd& residues,
                                    const MatrixXcd& metric) const {
  const auto g = static_cast<Index>(greens_.basis().form_count());
  if (!has_jacobian(residues.size())) return 0;
  MatrixXcd rows(g, residues.size());
  for (Index i = 0; i < residues.size(); ++i) rows.col(i) = residues[i] * tau_.at(vertices[i]);
  const MatrixXcd V = metric * rows;
  MatrixXcd S = V * V.adjoint();
  S += kLeastSquare * kEnough * kEnough * MatrixXcd::Identity(g, g);
  const MatrixXcd sum = S + kEnough * kEnough * MatrixXcd::Identity(g, g);
  // The sum of log(1 + (kEnough / sigma)^2) is log det(S + kEnough^2) - log det S, without an eigenproblem.
  return kWeight / static_cast<double>(g) *
         (std::log(std::abs(linear::determinant(sum))) - std::log(std::abs(linear::determinant(S))));
}

}  // namespace holomorph::tiling
