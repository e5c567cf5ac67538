#include "evening/descent.h"

#include <utility>

#include "base/chunks.h"

namespace holomorph::evening {
namespace {

constexpr std::size_t kMemory = 6;  // steps

}  // namespace

void Descent::take(Function step, Function change, Workers& workers) {
  const double curvature = product(step, change, workers);
  if (!(curvature > 0)) return;
  if (steps_.size() == kMemory) steps_.pop_front();
  steps_.push_back({std::move(step), std::move(change), curvature});
}

double Descent::product(const Function& a, const Function& b, Workers& workers) {
  return sum_over_rows(workers, static_cast<int>(a.size()), 0.0,
                       [&](int v, double& sum) { sum += a[v].real() * b[v].real() + a[v].imag() * b[v].imag(); });
}

void Descent::add(Function& a, double factor, const Function& b, Workers& workers) {
  for_rows(workers, static_cast<int>(a.size()), [&](int v) { a[v] += factor * b[v]; });
}

}  // namespace holomorph::evening
