// Maps that may be made of a part, and how the one of least cost is found among them.
#pragma once

#include <functional>
#include <vector>

#include "choice/map.h"
#include "choice/request.h"

namespace holomorph::choice {

/// Cost of a map that is so good that others are hardly worth their work, and of one so poor that much more is spent on
/// others.
inline constexpr double kGood = 0.8, kPoor = 2.4;
/// Times the budget: what takes longer is not made where there is a map, however poor.
inline constexpr double kFar = 10;

/// A map that may be made. Each is asked what it may cost before it is made.
struct Candidate {
  double work = 0;  ///< about what it takes, in what `Budget` counts
  /// About the least that it costs, found by little work; infinite where it is no better than `best`, which may be
  /// null.
  std::function<double(const MapPointer& best, Execution& execution)> bound;
  /// The map; null where there is none.
  std::function<MapPointer(const MapPointer& best, Execution& execution)> make;
  double times = 1;     ///< the budget within which it is made where there is another
  bool judges = false;  ///< whether what it makes is better than `best` by more than its cost tells, else null
};

/// Makes the candidates, one after the other, that may be better than what was found. @param best null for none
MapPointer least(const std::vector<Candidate>& candidates, MapPointer best, Budget& budget, Execution& execution);

/// The one of less cost, the first of equals; either may be null.
inline const MapPointer& cheaper(const MapPointer& one, const MapPointer& other) {
  return !one || (other && other->cost() < one->cost()) ? other : one;
}

}  // namespace holomorph::choice
