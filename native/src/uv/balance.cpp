#include "uv/balance.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <random>

#include "base/chunks.h"

namespace holomorph::uv {
namespace {

using Complex = std::complex<double>;
using Eigen::VectorXcd;
using Eigen::VectorXd;

// The floor under the density is lowered step by step, first from fixed pseudo-random starts on every kThinning-th
// sample, then from the best of their ends on all samples.
constexpr int kStarts = 16, kThinning = 4, kRoughSteps = 40, kKept = 6, kFineSteps = 100;
// From this many forms on, the number of starts falls in inverse proportion, as the cost of each grows faster.
constexpr int kManyForms = 64;
const std::vector<double> kRoughFloors = {1.0, 0.1}, kFineFloors = {0.01, 1e-3, kDensityFloor};

struct Candidate {
  double variance;
  VectorXd x;
};

// The candidate at the end of the descent from x.
Candidate lowered(const SampledParts& parts, Coefficients kind, VectorXd x, const std::vector<double>& floors,
                  int most_steps) {
  const double variance = descend(parts, kind, x, floors, most_steps);
  return {variance, std::move(x)};
}

}  // namespace

VectorXcd lowest_variance(const SampledParts& parts, Coefficients kind, Workers& workers) {
  const auto lower = [](const Candidate& a, const Candidate& b) { return a.variance < b.variance; };
  const auto every = Eigen::seq(0, Eigen::last, kThinning);
  const SampledParts thinned{parts.M(every, Eigen::all), parts.N(every, Eigen::all)};
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
    candidates[i] = lowered(thinned, kind, std::move(candidates[i].x), kRoughFloors, kRoughSteps);
  });
  std::stable_sort(candidates.begin(), candidates.end(), lower);
  candidates.resize(kept);
  run_throwing(workers, kept, [&](int i) {
    candidates[i] = lowered(parts, kind, std::move(candidates[i].x), kFineFloors, kFineSteps);
  });
  return as_complex(std::min_element(candidates.begin(), candidates.end(), lower)->x, kind);
}

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
