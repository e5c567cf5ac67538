// balanced_coefficients: the combination of holomorphic forms whose texture density is most even.
#include <algorithm>
#include <cmath>
#include <complex>
#include <random>

#include "mesh/triangle_geometry.h"
#include "uv/minimise.h"
#include "uv/uv_map.h"

namespace holomorph::uv {
namespace {

using Complex = std::complex<double>;
using Eigen::VectorXcd;
using Eigen::VectorXd;

constexpr int kSamples = 4000;  // faces that the density is sampled on, spaced evenly by area
// The floor under the density is lowered step by step: from fixed pseudo-random starts on every kThinning-th sample
// first, then from the best few of their ends on all samples.
constexpr int kStarts = 16, kThinning = 4, kRoughSteps = 40, kKept = 3, kFineSteps = 200;
constexpr double kRoughFloors[] = {1.0, 0.1}, kFineFloors[] = {0.01, 1e-3, 1e-4};

// Triangles met at kSamples equal steps through the total area; all of them on a small surface.
std::vector<int> sample_triangles(const mesh::Surface& surface) {
  const std::size_t count = surface.triangles.size();
  std::vector<double> until(count);
  double total = 0;
  for (std::size_t t = 0; t < count; ++t) {
    const auto& s = surface.triangle_edges[t];
    total += mesh::triangle_area(surface.edge_lengths[s[0]], surface.edge_lengths[s[1]], surface.edge_lengths[s[2]]);
    until[t] = total;
  }
  std::vector<int> samples;
  for (int i = 0; i < kSamples; ++i) {
    const double at = total * (i + 0.5) / kSamples;
    samples.push_back(static_cast<int>(std::min<std::ptrdiff_t>(std::lower_bound(until.begin(), until.end(), at) - until.begin(),
                                                                static_cast<std::ptrdiff_t>(count) - 1)));
  }
  return samples;
}

// Row s: the (1,0) parts (h_x - i h_y) / 2 of the basis forms theta_j on sample s, up to a common phase.
Eigen::MatrixXcd holomorphic_parts(const mesh::Surface& surface, const mesh::HalfEdges& half_edges, const forms::ClosedForms& forms,
                                   const Eigen::MatrixXcd& periods, const std::vector<int>& samples) {
  Eigen::MatrixXcd parts(static_cast<Eigen::Index>(samples.size()), forms.functions.cols());
  for (std::size_t s = 0; s < samples.size(); ++s) {
    mesh::HalfedgeHandle h = half_edges.halfedge_handle(mesh::FaceHandle(samples[s]));
    forms::RowMajorMatrix value(2, forms.functions.cols());
    double length[3];
    for (int i = 0; i < 3; ++i, h = mesh::next(half_edges, h)) {
      length[i] = surface.edge_lengths[mesh::edge_of(h)];
      if (i < 2) value.row(i) = mesh::sign(h) * forms::edge_values(half_edges, forms, mesh::edge_of(h), mesh::edge_of(h) + 1);
    }
    const auto [a, b, c] = length;
    const double area = mesh::triangle_area(a, b, c);
    const double x = (a * a + (c - b) * (c + b)) / (2 * a), y = 2 * area / a;
    // corner 0 at 0, corner 1 at a, corner 2 at x + i y: h(e0) = a h_x and h(e0) + h(e1) = x h_x + y h_y
    const VectorXd h_x = value.row(0).transpose() / a;
    const VectorXd h_y = ((value.row(0) + value.row(1)).transpose() - x * h_x) / y;
    parts.row(static_cast<Eigen::Index>(s)) = (0.5 * (h_x.cast<Complex>() - Complex(0, 1) * h_y.cast<Complex>())).transpose();
    if (!(area > 0)) parts.row(static_cast<Eigen::Index>(s)).setZero();
  }
  return parts * periods;
}

// Variance over the samples of log(q / mean q + floor), q = |M c|^2, and its gradient by (Re c, Im c).
class LogVariance {
 public:
  LogVariance(const Eigen::MatrixXcd& M, double floor) : M_(M), floor_(floor) {}

  double operator()(const VectorXd& x, VectorXd& gradient) const {
    const auto g = M_.cols();
    VectorXcd c(g);
    c.real() = x.head(g);
    c.imag() = x.tail(g);
    const VectorXcd theta = M_ * c;
    const Eigen::ArrayXd q = theta.cwiseAbs2().array();
    const double mean = q.mean();
    const Eigen::ArrayXd y = (q / mean + floor_).log(), deviation = y - y.mean();
    const Eigen::ArrayXd inverse = 1 / (q + floor_ * mean);
    // d/dq of each term, and through the mean, which is the same for all samples
    const double through_mean = -(deviation * q * inverse).mean() / mean;
    const Eigen::ArrayXd by_q = 2 * (deviation * inverse + through_mean) / static_cast<double>(q.size());
    const VectorXcd by_c = 2 * (M_.adjoint() * (by_q.cast<Complex>() * theta.array()).matrix());
    gradient.resize(2 * g);
    gradient << by_c.real(), by_c.imag();
    return deviation.square().mean();
  }

 private:
  const Eigen::MatrixXcd& M_;
  double floor_;
};

struct Candidate {
  double variance;
  VectorXd x;
};

template <std::size_t N>
Candidate descend(const Eigen::MatrixXcd& M, VectorXd x, const double (&floors)[N], int most_steps) {
  double variance = INFINITY;
  for (const double floor : floors) {
    variance = minimise(LogVariance(M, floor), x, most_steps);
    x.normalize();  // the variance does not depend on the scale
  }
  return {variance, std::move(x)};
}

VectorXd lowest_variance(const Eigen::MatrixXcd& M) {
  const auto lower = [](const Candidate& a, const Candidate& b) { return a.variance < b.variance; };
  const Eigen::MatrixXcd thinned = M(Eigen::seq(0, Eigen::last, kThinning), Eigen::all);
  std::mt19937_64 numbers(1);  // fixed: the same surface gives the same coefficients
  std::vector<Candidate> candidates;
  for (int start = 0; start < kStarts; ++start) {
    VectorXd x(2 * M.cols());
    // One number in [-1, 1) from each draw: the standard's distributions differ between libraries.
    for (auto& value : x) value = static_cast<double>(numbers() >> 11) * 0x1p-52 - 1.0;
    candidates.push_back(descend(thinned, std::move(x), kRoughFloors, kRoughSteps));
  }
  std::stable_sort(candidates.begin(), candidates.end(), lower);
  candidates.resize(kKept);
  for (auto& candidate : candidates) candidate = descend(M, std::move(candidate.x), kFineFloors, kFineSteps);
  return std::min_element(candidates.begin(), candidates.end(), lower)->x;
}

}  // namespace

VectorXcd balanced_coefficients(const mesh::Surface& surface, const mesh::HalfEdges& half_edges, const forms::ClosedForms& forms,
                                const Eigen::MatrixXcd& periods, const Eigen::MatrixXd& period_imaginary) {
  const auto g = periods.cols();
  VectorXcd c = VectorXcd::Ones(g);
  if (g > 1) {
    const Eigen::MatrixXcd M = holomorphic_parts(surface, half_edges, forms, periods, sample_triangles(surface));
    const VectorXd x = lowest_variance(M);
    c.real() = x.head(g);
    c.imag() = x.tail(g);
    Eigen::Index largest;
    c.cwiseAbs().maxCoeff(&largest);
    c *= std::conj(c[largest]) / std::abs(c[largest]);  // the phase is free: the largest coefficient is made positive
  }
  const double area = (c.adjoint() * period_imaginary.cast<Complex>() * c)(0, 0).real();  // (i/2) int theta ^ conj(theta)
  return c / std::sqrt(area);
}

}  // namespace holomorph::uv
