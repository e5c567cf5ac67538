#include "tiling/closest_vectors.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <set>
#include <tuple>

namespace holomorph::tiling {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

// A node of the tree: it has its parent's coefficients above `level`, `value` there, and Babai's choices below.
struct Node {
  double expected = 0;  // squared distance of the node's best vector
  int number = 0;       // in the order of their discovery: ties are resolved the same way each time
  double bound = 0;     // squared distance of the coefficients from `level` up: no vector of the node is closer
  int parent = -1;      // among the nodes visited
  int level = 0;
  double value = 0;
  bool operator<(const Node& other) const {
    return std::tie(expected, number) < std::tie(other.expected, other.number);
  }
};

// The value that follows in the order of distance from the centre: first, first + 1, first - 1, first + 2 ... where the
// centre is above the first, and mirrored where it is below.
double next_value(double centre, double value) {
  const double first = std::round(centre), side = centre >= first ? 1 : -1;
  const double step = side * (value - first);
  return first + side * (step > 0 ? -step : 1 - step);
}

class Enumeration {
 public:
  Enumeration(const Eigen::MatrixXd& R, const VectorXd& y, int count, int most_nodes)
      : R_(R), y_(y), count_(count), most_nodes_(most_nodes), expected_below_(R.cols()) {
    // A coefficient that is rounded is off by something uniform in [-1/2, 1/2], whose mean square is 1/12.
    double sum = 0;
    for (Index i = 0; i < R.cols(); ++i) {
      expected_below_[i] = sum;
      sum += R(i, i) * R(i, i) / 12;
    }
  }

  void run() {
    descend(static_cast<int>(R_.cols()));
    while (!open_.empty() && static_cast<int>(visited_.size()) + 1 < most_nodes_) {
      const Node node = *open_.begin();
      open_.erase(open_.begin());
      if (node.bound >= radius()) continue;
      visited_.push_back(node);
      descend(node.level);
    }
    for (const Node& node : open_) least_dropped_ = std::min(least_dropped_, node.bound);
  }

  struct Found {
    double squared_distance;
    VectorXd coefficients;
  };
  const std::vector<Found>& found() const { return found_; }
  bool proven() const { return least_dropped_ >= radius(); }

 private:
  double radius() const {
    return static_cast<int>(found_.size()) < count_ ? std::numeric_limits<double>::infinity()
                                                    : found_.back().squared_distance;
  }

  // Follows the node visited last to its vector. The nodes that branch off, at its level and below, are opened.
  void descend(int level) {
    std::vector<const Node*> chosen(R_.cols(), nullptr);
    const int last = static_cast<int>(visited_.size()) - 1;
    for (int i = last; i >= 0; i = visited_[i].parent) chosen[visited_[i].level] = &visited_[i];
    VectorXd y = y_, c = VectorXd::Zero(R_.cols());
    double distance = 0;
    for (int i = static_cast<int>(R_.cols()) - 1; i >= 0; --i) {
      const double centre = y[i] / R_(i, i);
      c[i] = chosen[i] ? chosen[i]->value : std::round(centre);
      if (i <= level) {
        const double value = next_value(centre, c[i]), offset = (centre - value) * R_(i, i);
        open(distance + offset * offset, i == level ? visited_[last].parent : last, i, value);
      }
      if (c[i] != 0) y.head(i + 1) -= c[i] * R_.col(i).head(i + 1);
      distance += y[i] * y[i];
      if (distance >= radius()) return;
    }
    const auto after = std::upper_bound(found_.begin(), found_.end(), distance,
                                        [](double d, const Found& other) { return d < other.squared_distance; });
    found_.insert(after, {distance, c});
    if (static_cast<int>(found_.size()) > count_) found_.pop_back();
  }

  // No more nodes are kept than may still be visited.
  void open(double bound, int parent, int level, double value) {
    if (bound >= radius()) return;
    open_.insert({bound + expected_below_[level], discovered_++, bound, parent, level, value});
    if (open_.size() + visited_.size() + 1 <= static_cast<std::size_t>(most_nodes_)) return;
    const auto worst = std::prev(open_.end());
    least_dropped_ = std::min(least_dropped_, worst->bound);
    open_.erase(worst);
  }

  const Eigen::MatrixXd& R_;
  const VectorXd& y_;
  int count_, most_nodes_, discovered_ = 0;
  VectorXd expected_below_;  // of the levels below each
  std::vector<Node> visited_;
  std::set<Node> open_;
  std::vector<Found> found_;  // ascending
  double least_dropped_ = std::numeric_limits<double>::infinity();
};

}  // namespace

ClosestVectors closest_vectors(const ReducedBasis& reduced, const VectorXd& target, int count, int most_nodes) {
  assert(count >= 1 && most_nodes >= 1);
  const VectorXd babai = nearest_coefficients(reduced, target);
  const VectorXd residual = target - reduced.basis * babai, y = reduced.Q.transpose() * residual;
  Enumeration enumeration(reduced.R, y, count, most_nodes);
  enumeration.run();
  ClosestVectors closest;
  closest.proven = enumeration.proven();
  for (const auto& found : enumeration.found()) {
    closest.vectors.push_back({original_integers(reduced, babai + found.coefficients),
                               (residual - reduced.basis * found.coefficients).squaredNorm()});
  }
  std::stable_sort(closest.vectors.begin(), closest.vectors.end(), [](const LatticeVector& a, const LatticeVector& b) {
    return a.squared_distance < b.squared_distance;
  });
  return closest;
}

}  // namespace holomorph::tiling
