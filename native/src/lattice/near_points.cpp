#include "lattice/near_points.h"

#include <cmath>

#include "base/errors.h"

namespace holomorph::lattice {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kLargestInteger = 9007199254740992;  // 2^53
constexpr std::int64_t kNodes = 2048;                 // between two calls of the tick: less than 10 ms

// Coordinates of R z near y are chosen from the last to the first, as R is upper triangular.
class Enumeration {
 public:
  Enumeration(const ReducedBasis& reduced, VectorXd y, std::int64_t most_steps, const std::function<void()>& tick)
      : R_(reduced.R), transform_(reduced.transform), y_(std::move(y)), most_steps_(most_steps), tick_(tick) {
    z_ = VectorXd::Zero(R_.cols());
  }

  NearPoints run(double left) {
    visit(R_.cols() - 1, left);
    return std::move(result_);
  }

 private:
  // `left`: what the coordinates after k have left of the squared radius.
  void visit(Index k, double left) {
    if (k < 0) return take();
    const Index after = R_.cols() - k - 1;
    const double centre = (y_[k] - R_.row(k).tail(after).dot(z_.tail(after))) / R_(k, k);
    const double radius = std::sqrt(left) / R_(k, k), last = std::floor(centre + radius);
    if (!(std::abs(centre) + radius <= kLargestInteger)) throw SolverError("the lattice needs integers beyond 2^53");
    for (double z = std::ceil(centre - radius); z <= last && result_.is_complete; ++z) {
      if (++result_.steps > most_steps_) {
        result_.is_complete = false;
        return;
      }
      if (tick_ && result_.steps % kNodes == 0) tick_();
      z_[k] = z;
      const double distance = (z - centre) * R_(k, k);
      visit(k - 1, std::max(0.0, left - distance * distance));
    }
  }

  void take() {
    const IntegerVector z = z_.cast<std::int64_t>();
    result_.integers.push_back(transform_ * z);
  }

  const Eigen::MatrixXd& R_;
  const IntegerMatrix& transform_;
  VectorXd y_, z_;
  std::int64_t most_steps_;
  const std::function<void()>& tick_;
  NearPoints result_;
};

}  // namespace

NearPoints near_points(const ReducedBasis& reduced, const VectorXd& target, double squared_radius,
                       std::int64_t most_steps, const std::function<void()>& tick) {
  const VectorXd y = reduced.Q.transpose() * target;
  // The distance from the span of the lattice is there whatever the point is.
  const double left = squared_radius - (target - reduced.Q * y).squaredNorm();
  if (!(left >= 0)) return {};
  return Enumeration(reduced, y, most_steps, tick).run(left);
}

}  // namespace holomorph::lattice
