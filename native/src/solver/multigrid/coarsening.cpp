#include "solver/multigrid/coarsening.h"

namespace holomorph::solver {
namespace {

// A connection is strong from this part of a vertex's largest weight on: across a stretched mesh the error is smooth
// only along its strong edges.
constexpr float kStrong = 0.2F;

}  // namespace

Coarsening coarsening(const Operator& fine) {
  constexpr int kUndecided = -2, kFPoint = -1;
  const int n = fine.A.size();
  Coarsening result{Array<int>(n)};
  Array<int>& number = result.number;
  std::fill(number.begin(), number.end(), kUndecided);
  for (int i = 0; i < n; ++i) {
    if (number[i] == kFPoint) continue;
    // An undecided vertex becomes a C-point. Its strong neighbours that are undecided can interpolate from it, and
    // become F-points.
    number[i] = result.count++;
    for (const auto [j, w] : fine.A[i]) {
      // without branches, which could not be predicted
      const bool strong = (w > 0) & (w >= kStrong * fine.largest[j]);
      const bool may_follow = fine.is_fixed(i) || !fine.is_fixed(j);
      const bool becomes_F = strong & (number[j] == kUndecided) & may_follow;
      number[j] = becomes_F ? kFPoint : number[j];
    }
  }
  return result;
}

}  // namespace holomorph::solver
