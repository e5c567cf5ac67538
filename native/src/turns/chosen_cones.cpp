#include "turns/chosen_cones.h"

#include <cmath>
#include <numbers>
#include <numeric>
#include <string>

#include "base/errors.h"
#include "turns/scale_form.h"

namespace holomorph::turns {

namespace {

constexpr double kGain = 1e-9;  // of the cost: less is rounding

}  // namespace

std::vector<int> with_holes(const Net& net, int k, const std::vector<int>& chosen, Execution& execution) {
  std::vector<int> missing = chosen, places;
  for (int v = 0; v < net.vertex_count(); ++v) {
    if (chosen[v] != 0 || net.hole[v] == v) places.push_back(v);
  }
  double defect = 0;
  for (int v = 0; v < net.vertex_count(); ++v) {
    if (net.first[v] >= 0) defect += net.defect[v];
  }
  const int whole = static_cast<int>(std::lround(defect / (2 * std::numbers::pi / k)));
  const int left = whole - std::accumulate(chosen.begin(), chosen.end(), 0);
  std::vector<Eigen::Index> holes;
  Eigen::VectorXd n(std::ssize(places));
  for (Eigen::Index i = 0; i < n.size(); ++i) {
    n[i] = chosen[places[i]];
    if (net.hole[places[i]] == places[i]) holes.push_back(i);
  }
  if (left != 0 && holes.empty()) {
    throw TopologyError("around the cones that are chosen " + std::to_string(whole - left) + "/" + std::to_string(k) +
                        " of a turn are missing in all; on this surface it must be " + std::to_string(whole) + "/" +
                        std::to_string(k));
  }
  if (holes.empty()) return missing;
  n[holes[0]] = left;
  ScaleForm form(net, k);
  form.take(places, [&] { execution.report(0); });
  for (bool gains = true; gains;) {
    const Eigen::VectorXd slope = form.Q() * n - form.b();
    double gained = kGain;
    Eigen::Index to = 0, from = 0;
    for (const Eigen::Index i : holes) {
      for (const Eigen::Index j : holes) {
        const double gain = 2 * (slope[j] - slope[i]) - form.Q()(i, i) - form.Q()(j, j) + 2 * form.Q()(i, j);
        if (i != j && gain > gained) gained = gain, to = i, from = j;
      }
    }
    gains = to != from;
    if (gains) n[to] += 1, n[from] -= 1;
  }
  for (const Eigen::Index i : holes) missing[places[i]] = static_cast<int>(n[i]);
  return missing;
}

}  // namespace holomorph::turns
