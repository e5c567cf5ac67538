// Quantiles of weighted values.
#pragma once

#include <vector>

#include "base/page_allocator.h"
#include "base/workers.h"

namespace holomorph::uv {

/// Shares at which the range of densities is measured.
inline constexpr double kLow = 0.05, kHigh = 0.95;

/// Weights of values >= 0 by the leading bits of the values, of which there are 16 classes in each octave: they are in
/// the order of the values. Only the items of the class with a quantile are visited again. Fewer values than classes
/// are all in one, which is visited sooner than all classes. Values and weights outlive this.
class Distribution {
 public:
  Distribution(const Array<double>& values, const Array<double>& weights, Workers& workers);

  /// The value below which this fraction of the total weight lies; 0 where there is none. Cost: linear
  double quantile(double fraction) const;

 private:
  struct Weighted {
    double value, weight;
  };
  static constexpr int kMost = 1 << 15;

  std::size_t begin(int part) const { return values_.size() * part / parts_; }
  std::size_t class_of(double value) const;
  std::vector<Weighted> items_of(std::size_t k) const;
  static double quantile(std::vector<Weighted>& items, double wanted);

  const Array<double>& values_;
  const Array<double>& weights_;
  Workers& workers_;
  const int parts_;  // number of parts processed in parallel
  std::vector<double> classes_;
  double total_ = 0;
};

}  // namespace holomorph::uv
