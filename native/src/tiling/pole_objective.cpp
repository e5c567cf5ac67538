#include "tiling/pole_objective.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>

namespace holomorph::tiling {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::VectorXcd;

constexpr double kLeverage = 0.06, kEnough = 0.4;  // weight of the leverage; singular values that are enough
constexpr int kSteps = 25;                         // at most, for the minimiser

PoleObjective::PoleObjective(Landscape& landscape, uv::Coefficients kind, int every)
    : landscape_(landscape),
      kind_(kind),
      every_(every),
      theta_(landscape.holomorphic().M(Eigen::seq(0, Eigen::last, every), Eigen::all)) {
  if (landscape.closed() && landscape.form_count() > 0) leverage_.emplace(landscape);
}

void PoleObjective::prepare(const std::vector<int>& vertices, Execution& execution) {
  landscape_.poles(vertices, execution);
  if (!leverage_) return;
  std::vector<int> missing = vertices;
  std::erase_if(missing, [&](int v) { return tau_.contains(v); });
  const MatrixXcd tau = leverage_->tau(leverage_->triangles_at(missing));
  for (std::size_t i = 0; i < missing.size(); ++i) tau_.emplace(missing[i], tau.col(static_cast<Index>(i)));
}

void PoleObjective::optimise(Poles& poles, const std::vector<double>& floors, Execution& execution) const {
  const uv::SampledParts parts{columns(poles.vertices, execution), {}};
  Eigen::VectorXd x = uv::as_unknowns(unknowns(poles), kind_);
  Eigen::ArrayXd density;
  for (const double floor : floors) {
    density = (parts.M * unknowns(poles)).cwiseAbs2().array();
    uv::descend(parts, kind_, x, {floor * median(density) / density.mean()}, kSteps);
    set(uv::as_complex(x, kind_), poles);
  }
  density = (parts.M * unknowns(poles)).cwiseAbs2().array();
  poles.variance = unevenness(density) + leverage_term(poles.vertices, poles.residues, leverage_metric(density));
}

VectorXcd PoleObjective::form(const Poles& poles, Execution& execution) const {
  return columns(poles.vertices, execution) * unknowns(poles);
}

// theta_j and the forms of the poles; closed: the last pole takes the rest.
MatrixXcd PoleObjective::columns(const std::vector<int>& vertices, Execution& execution) const {
  MatrixXcd poles = landscape_.poles(vertices, execution, every_);
  if (landscape_.closed() && poles.cols() > 0)
    poles = (poles.leftCols(poles.cols() - 1).colwise() - poles.col(poles.cols() - 1)).eval();
  MatrixXcd all(theta_.rows(), theta_.cols() + poles.cols());
  all << theta_, poles;
  return all;
}

VectorXcd PoleObjective::unknowns(const Poles& poles) const {
  const Index free = std::max<Index>(0, poles.residues.size() - (landscape_.closed() ? 1 : 0));
  VectorXcd x(poles.coefficients.size() + free);
  x << poles.coefficients, poles.residues.head(free);
  return x;
}

void PoleObjective::set(const VectorXcd& x, Poles& poles) const {
  const Index n = poles.coefficients.size(), free = x.size() - n;
  poles.coefficients = x.head(n);
  poles.residues.head(free) = x.tail(free);
  if (poles.residues.size() > free) poles.residues[free] = -x.tail(free).sum();
}

MatrixXcd PoleObjective::leverage_metric(const Eigen::ArrayXd& density) const {
  if (!leverage_) return {};
  const Eigen::LLT<MatrixXcd> metric(weighted_gram(theta_, density));
  return MatrixXcd(metric.matrixU()) * std::sqrt(landscape_.area());
}

// kLeverage mean log(1 + (kEnough / sigma)^2) over the singular values of [r_i tau_i] in the weighted Gram matrix.
double PoleObjective::leverage_term(const std::vector<int>& vertices, const VectorXcd& residues,
                                    const MatrixXcd& metric) const {
  const auto g = static_cast<Index>(landscape_.form_count());
  if (!leverage_ || residues.size() < g) return 0;
  MatrixXcd rows(g, residues.size());
  for (Index i = 0; i < residues.size(); ++i) rows.col(i) = residues[i] * tau_.at(vertices[i]);
  const MatrixXcd V = metric * rows;
  MatrixXcd S = V * V.adjoint();
  S += 1e-9 * MatrixXcd::Identity(g, g);
  const MatrixXcd sum = S + kEnough * kEnough * MatrixXcd::Identity(g, g);
  return kLeverage / static_cast<double>(g) *
         (std::log(std::abs(sum.determinant())) - std::log(std::abs(S.determinant())));
}

}  // namespace holomorph::tiling
