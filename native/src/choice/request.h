// What is asked for of one connected part, and how much work the search for its map may take.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "base/execution.h"
#include "choice/any_structure.h"
#include "choice/seamless_map.h"
#include "flat/island_search.h"
#include "uv/evening.h"

namespace holomorph::choice {

/// The map of least cost; a tiling in any case; the best of the others; a map of forms; islands between chosen cuts.
enum class Main { kAutomatic, kSeamless, kUntiled, kBalanced, kIslands };

struct Request {
  PartPointer part;
  StructurePointer structure = nullptr;  ///< null to make it, by `automatic_structure`
  Main main = Main::kAutomatic;
  double evenness = uv::kUsualEvenness;
  /// What is asked of tilings besides; its number of tiles, `size_counts`, `evenness` and `rows` do not count.
  TileOptions tiling = {};
  std::optional<tiling::Rows> rows = {};  ///< of tilings that turn; none: those that cost little
  flat::ChosenCuts cuts = {};             ///< of islands
  double effort = 1;                      ///< see `Budget`

  /// Whether v is to run up.
  bool is_upright() const { return tiling.heading.is_upright(); }
};

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
  static constexpr int kMany = 100'000;

  double most_;
  std::uint64_t spent_ = 0, begin_ = 0;
  int depth_ = 0;
  bool was_short_ = false;
};

}  // namespace holomorph::choice
