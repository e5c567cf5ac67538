#include "uv/balance.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <random>

#include "base/chunks.h"
#include "mesh/half_edges.h"
#include "mesh/triangle_geometry.h"
#include "uv/minimise.h"

namespace holomorph::uv {
namespace {

using Complex = std::complex<double>;
using Eigen::VectorXcd;
using Eigen::VectorXd;

constexpr int kSamples = 3000;  // triangles on which the density is sampled, evenly spaced by area
// The floor under the density is lowered step by step, first from fixed pseudo-random starts on every kThinning-th
// sample, then from the best of their ends on all samples.
constexpr int kStarts = 16, kThinning = 4, kRoughSteps = 40, kKept = 6, kFineSteps = 100;
// From this many forms on, the number of starts falls in inverse proportion, as the cost of each grows faster.
constexpr int kManyForms = 64;
constexpr double kDistortion = 3;  // weight of the distortion against the variance
constexpr double kRoughFloors[] = {1.0, 0.1}, kFineFloors[] = {0.01, 1e-3, 1e-4};

}  // namespace

// Triangles at kSamples equal steps through the total area.
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
    samples.push_back(static_cast<int>(std::min<std::ptrdiff_t>(
        std::lower_bound(until.begin(), until.end(), at) - until.begin(), static_cast<std::ptrdiff_t>(count) - 1)));
  }
  return samples;
}

forms::RowMajorMatrix values_on_sides(const mesh::Surface& surface, const forms::ClosedForms& forms,
                                      const std::vector<int>& triangles) {
  const mesh::Sides side(surface);
  forms::RowMajorMatrix values(2 * static_cast<Eigen::Index>(triangles.size()), forms.functions.cols());
  Eigen::Index row = 0;
  for (const int t : triangles) {
    for (const int i : {0, 1}) {
      const mesh::HalfedgeHandle h = side(t, i);
      values.row(row++) = mesh::sign(h) * forms::edge_values(surface, forms, mesh::edge_of(h), mesh::edge_of(h) + 1);
    }
  }
  return values;
}

namespace {

// A form is A dz + B conj(dz) on each triangle, with A = M c and B = N c on the samples.
struct Parts {
  Eigen::MatrixXcd M, N;  // #samples x g
};

// c as the unknowns of the minimiser: real parts, then imaginary ones where they are free.
VectorXcd as_complex(const VectorXd& x, Coefficients kind) {
  const auto g = kind == Coefficients::real ? x.size() : x.size() / 2;
  VectorXcd c = VectorXcd::Zero(g);
  c.real() = x.head(g);
  if (kind == Coefficients::complex) c.imag() = x.tail(g);
  return c;
}

// For a harmonic form h, A = (h_x - i h_y) / 2 up to a common phase, and B = conj(A).
Parts sampled_parts(const mesh::Surface& surface, const FormSamples& samples, const Eigen::MatrixXcd& basis) {
  Eigen::MatrixXcd parts(static_cast<Eigen::Index>(samples.triangles.size()), samples.on_sides.cols());
  for (std::size_t s = 0; s < samples.triangles.size(); ++s) {
    const auto value = samples.on_sides.middleRows(2 * static_cast<Eigen::Index>(s), 2);
    const auto [side0, side1, side2] = surface.triangle_edges[samples.triangles[s]];
    const double a = surface.edge_lengths[side0], b = surface.edge_lengths[side1], c = surface.edge_lengths[side2];
    const double area = mesh::triangle_area(a, b, c);
    const double x = (a * a + (c - b) * (c + b)) / (2 * a), y = 2 * area / a;
    // corner 0 at 0, corner 1 at a, corner 2 at x + i y: h(e0) = a h_x and h(e0) + h(e1) = x h_x + y h_y
    const VectorXd h_x = value.row(0).transpose() / a;
    const VectorXd h_y = ((value.row(0) + value.row(1)).transpose() - x * h_x) / y;
    parts.row(static_cast<Eigen::Index>(s)) =
        (0.5 * (h_x.cast<Complex>() - Complex(0, 1) * h_y.cast<Complex>())).transpose();
    if (!(area > 0)) parts.row(static_cast<Eigen::Index>(s)).setZero();
  }
  return {parts * basis, parts.conjugate() * basis};
}

// Variance over the samples of log(q / mean q + floor), q = |A|^2, plus kDistortion times the mean of
// r = |B|^2 / (|A|^2 + |B|^2 + floor mean q); and the gradient by (Re c, Im c). The second term is nearly 0 for a
// good map; without it |A| may be even where B, the discretisation error, exceeds it and the map is flipped.
class LogVariance {
 public:
  LogVariance(const Parts& parts, Coefficients kind, double floor) : parts_(parts), kind_(kind), floor_(floor) {}

  double operator()(const VectorXd& x, VectorXd& gradient) const {
    const VectorXcd c = as_complex(x, kind_);
    const VectorXcd A = parts_.M * c, B = parts_.N * c;
    const Eigen::ArrayXd q = A.cwiseAbs2().array(), b = B.cwiseAbs2().array();
    const double mean = q.mean(), count = static_cast<double>(q.size());
    const Eigen::ArrayXd y = (q / mean + floor_).log(), deviation = y - y.mean();
    const Eigen::ArrayXd inverse = 1 / (q + floor_ * mean);
    const Eigen::ArrayXd sum = 1 / (q + b + floor_ * mean), r = b * sum;
    // Derivatives by q and b of each sample, and through the mean, which is the same for all samples.
    const double through_mean = -2 * (deviation * q * inverse).mean() / mean - kDistortion * floor_ * (r * sum).mean();
    const Eigen::ArrayXd by_q = (2 * deviation * inverse - kDistortion * r * sum + through_mean) / count;
    const Eigen::ArrayXd by_b = kDistortion * (1 - r) * sum / count;
    const VectorXcd weighted_A = (by_q.cast<Complex>() * A.array()).matrix(),
                    weighted_B = (by_b.cast<Complex>() * B.array()).matrix();
    const VectorXcd by_c = 2 * (parts_.M.adjoint() * weighted_A + parts_.N.adjoint() * weighted_B);
    gradient.resize(x.size());
    gradient.head(c.size()) = by_c.real();
    if (kind_ == Coefficients::complex) gradient.tail(c.size()) = by_c.imag();
    return deviation.square().mean() + kDistortion * r.mean();
  }

 private:
  const Parts& parts_;
  Coefficients kind_;
  double floor_;
};

struct Candidate {
  double variance;
  VectorXd x;
};

template <std::size_t N>
Candidate descend(const Parts& parts, Coefficients kind, VectorXd x, const double (&floors)[N], int most_steps) {
  double variance = INFINITY;
  for (const double floor : floors) {
    variance = minimise(LogVariance(parts, kind, floor), x, most_steps);
    x.normalize();  // the variance does not depend on the scale
  }
  return {variance, std::move(x)};
}

VectorXcd lowest_variance(const Parts& parts, Coefficients kind, Workers& workers) {
  const auto lower = [](const Candidate& a, const Candidate& b) { return a.variance < b.variance; };
  const auto every = Eigen::seq(0, Eigen::last, kThinning);
  const Parts thinned{parts.M(every, Eigen::all), parts.N(every, Eigen::all)};
  std::mt19937_64 numbers(1);  // fixed: the same surface gives the same coefficients
  const auto unknowns = (kind == Coefficients::real ? 1 : 2) * parts.M.cols();
  const auto fewer = [&](int count, int least) {
    return std::max(least, count * kManyForms / std::max(kManyForms, static_cast<int>(parts.M.cols())));
  };
  const int starts = fewer(kStarts, 2), kept = fewer(kKept, 1);
  std::vector<Candidate> candidates(starts, {INFINITY, VectorXd(unknowns)});
  for (auto& candidate : candidates) {
    // One number in [-1, 1) from each draw: the standard's distributions differ between libraries.
    for (auto& value : candidate.x) value = static_cast<double>(numbers() >> 11) * 0x1p-52 - 1.0;
  }
  // Descents are independent, so the result does not depend on the number of threads.
  run_throwing(workers, starts, [&](int i) {
    candidates[i] = descend(thinned, kind, std::move(candidates[i].x), kRoughFloors, kRoughSteps);
  });
  std::stable_sort(candidates.begin(), candidates.end(), lower);
  candidates.resize(kept);
  run_throwing(workers, kept, [&](int i) {
    candidates[i] = descend(parts, kind, std::move(candidates[i].x), kFineFloors, kFineSteps);
  });
  return as_complex(std::min_element(candidates.begin(), candidates.end(), lower)->x, kind);
}

}  // namespace

VectorXcd balanced_coefficients(const mesh::Surface& surface, const FormSamples& samples, const Eigen::MatrixXcd& basis,
                                Coefficients kind, Workers& workers) {
  if (basis.cols() == 1) return VectorXcd::Ones(1);
  VectorXcd c = lowest_variance(sampled_parts(surface, samples, basis), kind, workers);
  Eigen::Index largest;
  c.cwiseAbs().maxCoeff(&largest);
  const Complex phase = std::conj(c[largest]) / std::abs(c[largest]);
  return c * phase;  // the phase is free: the largest coefficient is made positive
}

}  // namespace holomorph::uv
