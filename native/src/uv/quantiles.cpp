#include "uv/quantiles.h"

#include <algorithm>
#include <bit>
#include <cstdint>

#include "base/chunks.h"

namespace holomorph::uv {

Distribution::Distribution(const Array<double>& values, const Array<double>& weights, Workers& workers)
    : values_(values),
      weights_(weights),
      workers_(workers),
      parts_(values.size() < kMost ? 1 : 8),
      classes_(parts_ > 1 ? kMost : 1, 0.0) {
  std::vector<std::vector<double>> parts(parts_, classes_);
  workers.run(parts_, [&](int, int part) {
    for (std::size_t i = begin(part); i < begin(part + 1); ++i) parts[part][class_of(values[i])] += weights[i];
  });
  for (const auto& part : parts) {
    for (std::size_t k = 0; k < classes_.size(); ++k) classes_[k] += part[k];
  }
  for (const double weight : classes_) total_ += weight;
}

double Distribution::quantile(double fraction) const {
  if (!(total_ > 0)) return 0;
  double wanted = fraction * total_;
  std::size_t k = 0;
  for (; k + 1 < classes_.size() && !(classes_[k] >= wanted && classes_[k] > 0); ++k) wanted -= classes_[k];
  std::vector<Weighted> items = items_of(k);
  return items.empty() ? 0.0 : quantile(items, wanted);
}

std::vector<Distribution::Weighted> Distribution::items_of(std::size_t k) const {
  std::vector<std::vector<Weighted>> parts(parts_);
  run_throwing(workers_, parts_, [&](int part) {
    for (std::size_t i = begin(part); i < begin(part + 1); ++i) {
      if (class_of(values_[i]) == k) parts[part].push_back({values_[i], weights_[i]});
    }
  });
  std::vector<Weighted> items;
  for (const auto& part : parts) items.insert(items.end(), part.begin(), part.end());
  return items;
}

// The sign, the exponent and four bits of the mantissa: 16 classes in an octave.
std::size_t Distribution::class_of(double value) const {
  return (std::bit_cast<std::uint64_t>(value) >> 48) % classes_.size();
}

// By halving the range in which the weight `wanted` is: linear time.
double Distribution::quantile(std::vector<Weighted>& items, double wanted) {
  auto begin = items.begin(), end = items.end();
  while (end - begin > 1) {
    const auto middle = begin + (end - begin) / 2;
    std::nth_element(begin, middle, end, [](const Weighted& a, const Weighted& b) { return a.value < b.value; });
    double below = 0;
    for (auto item = begin; item != middle; ++item) below += item->weight;
    if (below >= wanted) {
      end = middle;
    } else {
      wanted -= below;
      begin = middle;
    }
  }
  return begin->value;
}

}  // namespace holomorph::uv
