// The values that lines of a lattice have: which parts of a function are one number along them.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "base/held.h"

namespace holomorph::tiling {

/// A sum of multiples of whole numbers, or of lines, by their numbers.
using Multiples = std::map<int, double>;

inline void add_to(Multiples& sum, const Multiples& other, double factor = 1) {
  if (factor == 0) return;
  for (const auto& [number, multiple] : other) sum[number] += factor * multiple;
}

/// Parts of a function, 2 v and 2 v + 1 at vertex v. Those on one line are its root, or less that, and whole numbers.
class LineValues {
 public:
  /// @param whole whether lines have whole numbers. Where a line meets itself turned round, it would be half of one:
  /// that is to be whole then
  LineValues(int vertex_count, bool whole) : parent_(2 * static_cast<std::size_t>(vertex_count)), whole_(whole) {}

  /// factor times a part, and the offset; the offset alone where the part is -1.
  struct Value {
    int part = -1, factor = 1;
    Multiples offset;
  };
  /// What is to be 0.
  struct Equation {
    Multiples roots, offset;
  };

  void equate(const Value& a, const Value& b);
  /// Asks that a sum of multiples of parts, and of whole numbers, be 0. The parts become lines if they are on none.
  void vanish(const Multiples& parts, Multiples offset);

  std::optional<Value> find(int part);  ///< by the root, or by whole numbers alone; none: it is on no line
  std::vector<int> roots();             ///< ascending
  std::vector<Equation> equations();

 private:
  Value resolved(const Value& value);
  Value& above(int part) { return held(parent_[part]); }

  std::vector<std::optional<Value>> parent_;  // none on no line; itself at a root
  const bool whole_;
  std::vector<Equation> equations_;  // of parts that were roots
};

}  // namespace holomorph::tiling
