#include "tiling/poles/candidate_scores.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace holomorph::tiling {
namespace {

constexpr int kMantissa = 23, kBias = 127;
constexpr float kOctave = 0.69314718F;  // log 2
// Bins of the histogram of logarithms of base 2, for the median.
constexpr int kBins = 1032, kBinsPerOctave = 4;

// Real parts above imaginary ones.
Eigen::VectorXf halves(const VectorXcd& A) {
  Eigen::VectorXf result(2 * A.size());
  result << A.real().cast<float>(), A.imag().cast<float>();
  return result;
}

// log2 of a positive float to 2e-5: the exponent and a polynomial for the mantissa.
float log2_of(float x) {
  const auto bits = std::bit_cast<std::int32_t>(x);
  const float exponent = static_cast<float>((bits >> kMantissa) - kBias);
  const float t = std::bit_cast<float>((bits & ((1 << kMantissa) - 1)) | (kBias << kMantissa)) - 1;
  return exponent + t * (1.44183587F + t * (-0.70837215F + t * (0.41355505F + t * (-0.19126251F + t * 0.04424374F))));
}

// The median of logarithms of base 2, from a histogram, by interpolation inside its bin. Zero and infinity have bins,
// too.
float middle(const std::vector<float>& logarithms) {
  std::array<int, kBins> counts{};
  for (const float l : logarithms) ++counts[static_cast<int>((l + kBias + 1) * kBinsPerOctave)];
  auto left = static_cast<int>(logarithms.size() / 2);
  int bin = 0;
  while (left >= counts[bin]) left -= counts[bin++];
  const float part = (static_cast<float>(left) + 0.5F) / static_cast<float>(counts[bin]);
  return (static_cast<float>(bin) + part) / kBinsPerOctave - kBias - 1;
}

}  // namespace

void CandidateScores::prepare(const std::vector<int>& vertices) {
  for (const int v : vertices) {
    if (!columns_.contains(v)) columns_.emplace(v, halves(greens_.at({v}, every_).col(0)));
  }
}

void CandidateScores::set_rest(const VectorXcd& A, double median) {
  scale_ = 1 / std::sqrt(median);
  rest_ = halves(scale_ * A);
}

double CandidateScores::operator()(int vertex, Complex residue) const {
  const Index count = rest_.size() / 2;
  const Complex r = scale_ * residue;
  const auto re = static_cast<float>(r.real()), im = static_cast<float>(r.imag());
  const float *a = rest_.data(), *b = a + count;
  const float *x = columns_.at(vertex).data(), *y = x + count;
  thread_local std::vector<float> logarithms;
  logarithms.resize(count);
  float* l = logarithms.data();
  for (Index i = 0; i < count; ++i) {
    const float u = a[i] + (re * x[i] - im * y[i]), v = b[i] + (re * y[i] + im * x[i]);
    l[i] = log2_of(u * u + v * v);
  }
  // max(q, floor) in place of q + floor: in logarithms this needs no exponential.
  const float floor = middle(logarithms) + static_cast<float>(std::log2(uv::kDensityFloor));
  const Eigen::ArrayXf above = Eigen::Map<const Eigen::ArrayXf>(l, count).max(floor) - floor;
  return kOctave * kOctave * (above - above.mean()).square().mean();
}

}  // namespace holomorph::tiling
