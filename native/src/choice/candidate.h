// Maps that may be made of a part, the work that this may take, and how the one of least cost is found.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <vector>

#include "base/execution.h"
#include "choice/map.h"

namespace holomorph::choice {

/// The work that the search for the map of one part may take, in operations of about a nanosecond: not by the clock,
/// and the same at any number of threads. What is found first is kept, however long it took. For one thread at a time.
class Budget {
 public:
  /// @param triangles of the part. @param effort times the usual, some 5 s of one processor at 20,000 triangles
  explicit Budget(int triangles, double effort = 1) : most_(effort * (kAny + kEach * std::min(triangles, kMany))) {}

  /// Counts while alive, also one within another.
  class Counting {
   public:
    explicit Counting(Budget& budget) : budget_(budget) {
      if (budget_.depth_++ == 0) budget_.begin_ = Execution::work();
    }
    ~Counting() {
      if (--budget_.depth_ == 0) budget_.spent_ += Execution::work() - budget_.begin_;
    }
    Counting(const Counting&) = delete;
    Counting& operator=(const Counting&) = delete;

   private:
    Budget& budget_;
  };

  /// Whether there is so much left, of so many times the budget.
  bool allows(double work = 0, double times = 1) const {
    const std::uint64_t now = depth_ > 0 ? Execution::work() - begin_ : 0;
    return static_cast<double>(spent_ + now) + work < times * most_;
  }
  /// The same, asked where something is left out otherwise.
  bool goes_on(double work = 0, double times = 1) {
    const bool is_left = allows(work, times);
    was_short_ |= !is_left;
    return is_left;
  }
  /// Whether something was left out.
  bool was_short() const { return was_short_; }

 private:
  static constexpr double kAny = 1e9, kEach = 2e5;  // for any part, and for each triangle of up to so many
  static constexpr int kMany = 45'000;

  double most_;
  std::uint64_t spent_ = 0, begin_ = 0;
  int depth_ = 0;
  bool was_short_ = false;
};

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

/// Makes the candidates, one after the other, that may be better than what was found. One that is refused is left out;
/// where its bound is, it is made. @param best null for none. @throws Cancelled
MapPointer least(const std::vector<Candidate>& candidates, MapPointer best, Budget& budget, Execution& execution);

/// The one of less cost, the first of equals; either may be null.
inline const MapPointer& cheaper(const MapPointer& one, const MapPointer& other) {
  return !one || (other && other->cost() < one->cost()) ? other : one;
}

}  // namespace holomorph::choice
