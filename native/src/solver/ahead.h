// Memory that a loop comes to later, asked for while another one computes.
#pragma once

#include <array>
#include <cstddef>

#include "base/prefetch.h"

namespace holomorph::solver {

/// Several arrays' parts, cache line by cache line. The processor looks ahead by itself along one array, but not to the
/// next chunk of each of many while it is busy with sums.
class Ahead {
 public:
  /// @pre not empty; not more than kMost times
  template <class T>
  void add(const T* begin, const T* end) {
    parts_[count_++] = {reinterpret_cast<const char*>(begin), reinterpret_cast<const char*>(end)};
  }

  /// Asks for the next line; for nothing more after the last one.
  void ask() {
    if (at_ == count_) return;
    Part& part = parts_[at_];
    prefetch_for_later(part.next);
    part.next += kLine;
    at_ += part.next >= part.end;
  }

 private:
  static constexpr int kMost = 4;
  static constexpr std::ptrdiff_t kLine = 64;
  struct Part {
    const char *next, *end;
  };
  std::array<Part, kMost> parts_;
  int count_ = 0, at_ = 0;
};

}  // namespace holomorph::solver
