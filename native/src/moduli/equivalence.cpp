#include "moduli/equivalence.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace holomorph::moduli {
namespace {

// Residuals of less are rounding, whatever the bounds.
constexpr double kRounding = 1e-9;
// Residuals are allowed to grow by this factor from search to search: the nearest isometries are found among few.
constexpr double kFirstPart = 1e-4, kGrowth = 100;
// By this factor a mirror image has to be nearer than the surface itself: many surfaces are nearly their mirror images.
constexpr double kNearer = 4;
// The margin is looked for in doubling steps, from one to the other: dilatations up to 4.
constexpr double kFirstMargin = 1e-3, kLargestMargin = 2 * std::numbers::ln2;
// Part of the steps that each of these searches may take: the verdict is known without them.
constexpr std::int64_t kMarginPart = 100;

const Isometry* nearest(const Isometries& isometries) {
  const auto less = [](const Isometry& x, const Isometry& y) { return x.residual < y.residual; };
  const auto found = std::min_element(isometries.found.begin(), isometries.found.end(), less);
  return found == isometries.found.end() ? nullptr : &*found;
}

class Judge {
 public:
  Judge(const PeriodLattice& a, const PeriodLattice& b, double allowed, double needed, std::int64_t steps,
        Execution& execution)
      : a_(a), b_(b), allowed_(allowed), needed_(needed), steps_(steps), execution_(execution) {}

  Comparison run() {
    const double of_a = radius(a_), of_b = radius(b_);
    execution_.stage("integer matrices", 0, 0.3);
    const bool agree = look_near(std::max({kRounding, allowed_, needed_}));
    execution_.stage("integer matrices", 0.3, 0.6);
    if (!agree) take_nearest(a_, b_, allowed_, result_.is_complete);
    const double found = result_.isometry ? result_.isometry->residual : std::numeric_limits<double>::infinity();
    result_.tolerance = found + of_a + of_b;
    execution_.stage("margin", 0.6, 1);
    if (!result_.isometry && result_.is_complete) exclude();
    execution_.finish();
    return result_;
  }

 private:
  // Whether projected periods agree to `needed`; then that is the verdict.
  bool look_near(double needed) {
    const PeriodLattice a = projected_lattice(a_), b = projected_lattice(b_);
    bool is_complete = true;
    for (double part = kFirstPart; is_complete && part <= 1; part *= kGrowth) {
      if (!take_nearest(a, b, std::max(kRounding, part * needed), is_complete)) continue;
      result_.verdict = result_.sign > 0 ? Verdict::indistinguishable : Verdict::mirror_image;
      result_.margin = needed - result_.isometry->residual;
      return true;
    }
    return false;
  }

  bool take_nearest(const PeriodLattice& a, const PeriodLattice& b, double slack, bool& is_complete) {
    const Isometries same = isometries(a, b, {1, slack, steps_}, execution_);
    const Isometries mirrored = isometries(a, b, {-1, slack, steps_}, execution_);
    is_complete = same.is_complete && mirrored.is_complete;
    const Isometry *first = nearest(same), *second = nearest(mirrored);
    if (first == nullptr && second == nullptr) return false;
    const bool is_mirrored =
        first == nullptr || (second != nullptr && kNearer * std::max(kRounding, second->residual) < first->residual);
    result_.isometry = is_mirrored ? *second : *first;
    result_.sign = is_mirrored ? -1 : 1;
    return true;
  }

  // The margin is certain: all isometries up to some slack are found, the last of which has the least excess.
  void exclude() {
    result_.verdict = Verdict::not_equivalent;
    result_.margin = allowed_;
    for (double slack = allowed_ + kFirstMargin;; slack = std::min(2 * slack, kLargestMargin)) {
      double least = slack;
      for (const int sign : {1, -1}) {
        const auto isometries = moduli::isometries(a_, b_, {sign, slack, steps_ / kMarginPart}, execution_);
        if (!isometries.is_complete) return;
        for (const Isometry& isometry : isometries.found) least = std::min(least, isometry.excess);
      }
      result_.margin = least;
      if (least < slack || slack >= kLargestMargin) return;
    }
  }

  const PeriodLattice &a_, &b_;
  double allowed_, needed_;
  std::int64_t steps_;
  Execution& execution_;
  Comparison result_;
};

}  // namespace

Comparison compare(const PeriodLattice& a, const PeriodLattice& b, double allowed, double needed, std::int64_t steps,
                   Execution& execution) {
  return Judge(a, b, allowed, needed, steps, execution).run();
}

}  // namespace holomorph::moduli
