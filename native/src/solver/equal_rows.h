// A sparse matrix with equally many entries in each row.
#pragma once

#include "base/page_allocator.h"

namespace holomorph::solver {

struct Entry {
  int column;
  float weight;
};

/// Rows of `each` entries, the largest weight first; what is missing has weight 0 and the first entry's column: in the
/// cache already, and cheaper than to find out how many there are.
struct EqualRows {
  int each = 1;
  Array<Entry> entry;

  int size() const { return static_cast<int>(entry.size()) / each; }
  const Entry* operator[](int i) const { return entry.data() + static_cast<std::ptrdiff_t>(each) * i; }
};

}  // namespace holomorph::solver
