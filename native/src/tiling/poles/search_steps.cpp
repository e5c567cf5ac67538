#include "tiling/poles/search_steps.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "base/constants.h"
#include "base/errors.h"
#include "base/workers.h"

namespace holomorph::tiling {
namespace {

constexpr int kFloatMantissa = 23, kBias = 127;
constexpr float kOctave = 0.69314718F;  // log 2
// Bins of the histogram of logarithms of base 2, for the median.
constexpr int kBins = 1032, kBinsPerOctave = 4;

// Real parts above imaginary ones.
Eigen::VectorXf as_floats(const VectorXcd& A) {
  Eigen::VectorXf result(2 * A.size());
  result << A.real().cast<float>(), A.imag().cast<float>();
  return result;
}

// log2 of a positive float to 2e-5: the exponent and a polynomial for the mantissa.
float log2_of(float x) {
  const auto bits = std::bit_cast<std::int32_t>(x);
  const float exponent = static_cast<float>((bits >> kFloatMantissa) - kBias);
  const float t = std::bit_cast<float>((bits & ((1 << kFloatMantissa) - 1)) | (kBias << kFloatMantissa)) - 1;
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

// Candidates that are optimised: when a pole is added, or hidden, and when it moves.
constexpr int kTried = 4, kRefined = 2;
// Sizes of residues that a new pole is tried with, relative to the root of mean density times area.
constexpr double kTrialSizes[] = {0.1, 0.3, 1.0};
constexpr int kTrialPhases = 6;
const std::vector<double> kWithTrial = {0.03, uv::kDensityFloor};

constexpr int kThinning = 3;           // a third of the samples is enough to choose what is tried
constexpr double kUsualValues = 3000;  // usual evaluations of the objective in a search
constexpr double kOperations = 1.5;    // of an evaluation, for each sample and form

VectorXcd thinned(const VectorXcd& samples) { return samples(Eigen::seq(0, Eigen::last, kThinning)); }

// Adds a pole; the others share the opposite of its residue where the sum has to be 0.
MeromorphicForm joined(MeromorphicForm form, int vertex, Complex residue, bool closed) {
  const Index k = form.residues.size();
  if (closed && k > 0) form.residues.array() -= residue / static_cast<double>(k);
  form.poles.push_back(vertex);
  form.residues.conservativeResize(k + 1);
  form.residues[k] = closed && k == 0 ? 0 : residue;
  return form;
}

}  // namespace

void CandidateScores::prepare(const std::vector<int>& vertices) {
  for (const int v : vertices) {
    if (!columns_.contains(v)) columns_.emplace(v, as_floats(greens_.at({v}, every_).col(0)));
  }
}

void CandidateScores::set_rest(const VectorXcd& A, double median) {
  scale_ = 1 / std::sqrt(median);
  rest_ = as_floats(scale_ * A);
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

SearchSteps::SearchSteps(GreensFunctions& greens, const PlaceOptions& options, int every, Execution& execution)
    : greens_(greens),
      basis_(greens.basis()),
      options_(options),
      execution_(execution),
      candidates_(basis_, options),
      objective_(greens, options.kind, every),
      watch_(execution, kUsualValues, kOperations * static_cast<double>(basis_.holomorphic().M.size()) / every),
      every_(every),
      scores_(greens, every * kThinning) {}

void SearchSteps::begin_hiding(const std::vector<int>& poles, double worth, double share) {
  exposure_.emplace(basis_.surface());
  exposure_->prepare(poles, execution_.workers());
  weight_ = worth;
  share_ = share;
}

// The objective; while poles are hidden, with their weighted exposure, and infinite if it has grown too much.
double SearchSteps::price(const MeromorphicForm& form) const {
  if (!exposure_) return form.objective;
  if (form.objective > limit_) return INFINITY;
  double seen = 0;
  for (const int v : form.poles) seen += (*exposure_)(v);
  return form.objective + weight_ * seen / static_cast<double>(form.poles.size());
}

// Scores all candidates for pole i, with residues and coefficients as they are, and optimises the best ones.
bool SearchSteps::exchange(MeromorphicForm& form, Index i) {
  std::vector<int> others = form.poles;
  others.erase(others.begin() + i);
  const std::vector<int> candidates = candidates_.for_move(form.poles[i], others);
  if (candidates.empty()) return false;
  limit_ = form.objective + share_;
  if (exposure_) exposure_->prepare(candidates, execution_.workers());
  const Index k = form.residues.size();
  objective_.prepare(candidates, k, execution_);
  scores_.prepare(candidates);
  const VectorXcd A = objective_.samples_of(form), now = thinned(A);
  // The form without the pole that moves is common to all candidates.
  scores_.set_rest(now - greens_.at({form.poles[i]}, every_ * kThinning) * form.residues.segment(i, 1),
                   median(now.cwiseAbs2().array()));
  objective_.prepare(form.poles, k, execution_);
  const MatrixXcd metric = objective_.jacobian_metric(A.cwiseAbs2().array(), k);
  std::vector<std::pair<double, int>> scores(candidates.size());
  run_throwing(execution_.workers(), static_cast<int>(candidates.size()), [&](int j) {
    std::vector<int> vertices = form.poles;
    vertices[i] = candidates[j];
    const int v = candidates[j];
    const double seen = exposure_ ? weight_ * (*exposure_)(v) / static_cast<double>(k) : 0;
    scores[j] = {scores_(v, form.residues[i]) + objective_.jacobian_term(vertices, form.residues, metric) + seen, v};
  });
  std::sort(scores.begin(), scores.end());
  std::vector<MeromorphicForm> tried;
  for (int j = 0; j < std::min<int>(exposure_ ? kTried : kRefined, static_cast<int>(scores.size())); ++j) {
    tried.push_back(form);
    tried.back().poles[i] = scores[j].second;
  }
  MeromorphicForm found = best_optimised(std::move(tried), kFromNear);
  if (price(found) > price(form) * (1 - kGain)) return false;
  form = std::move(found);
  return true;
}

// Tries the best-scored places and residues.
bool SearchSteps::add_one(MeromorphicForm& form) {
  const std::size_t count = form.poles.size();
  std::vector<MeromorphicForm> tried;
  for (const Trial& trial : trials_everywhere(form)) {
    if (std::ssize(tried) == kTried) break;
    const bool known = std::any_of(tried.begin(), tried.end(),
                                   [&](const MeromorphicForm& p) { return p.poles[count] == trial.vertex; });
    if (known) continue;
    tried.push_back(joined(form, trial.vertex, trial.residue, basis_.closed()));
  }
  if (tried.empty()) return false;
  std::vector<int> vertices = form.poles;
  for (const MeromorphicForm& each : tried) vertices.push_back(each.poles[count]);
  objective_.prepare(vertices, tried.front().residues.size(), execution_);
  tried = all_optimised(std::move(tried), kWithTrial);
  form = *std::ranges::min_element(tried, {}, &MeromorphicForm::objective);
  return true;
}

// Scores all candidates with all trial residues, the form as it is, and returns them the best first.
std::vector<SearchSteps::Trial> SearchSteps::trials_everywhere(const MeromorphicForm& form) {
  const std::vector<int> candidates = candidates_.everywhere(form.poles);
  greens_.solve_at(candidates, execution_);
  scores_.prepare(candidates);
  const VectorXcd A = thinned(objective_.samples_of(form));
  scores_.set_rest(A, median(A.cwiseAbs2().array()));
  const double scale = std::sqrt(A.cwiseAbs2().mean() * basis_.area());
  const int phases = options_.kind == uv::Coefficients::real ? 2 : kTrialPhases;
  std::vector<Trial> trials;
  for (const int v : candidates) {
    for (const double size : kTrialSizes) {
      for (int j = 0; j < phases; ++j) trials.push_back({0, v, std::polar(size * scale, kTwoPi * j / phases)});
    }
  }
  run_throwing(execution_.workers(), static_cast<int>(trials.size()),
               [&](int j) { trials[j].value = scores_(trials[j].vertex, trials[j].residue); });
  std::stable_sort(trials.begin(), trials.end(), [](const Trial& a, const Trial& b) { return a.value < b.value; });
  return trials;
}

std::vector<MeromorphicForm> SearchSteps::all_optimised(std::vector<MeromorphicForm> list,
                                                        const std::vector<double>& floors) {
  run_long_tasks(execution_.workers(), static_cast<int>(list.size()),
                 [&](int thread, int i) { objective_.optimise(list[i], floors, [&] { watch_(thread); }); });
  return list;
}

MeromorphicForm SearchSteps::best_optimised(std::vector<MeromorphicForm> list, const std::vector<double>& floors) {
  list = all_optimised(std::move(list), floors);
  return held(std::ranges::min_element(list, {}, [&](const MeromorphicForm& form) { return price(form); }), list);
}

}  // namespace holomorph::tiling
