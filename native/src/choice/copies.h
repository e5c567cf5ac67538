// Parts that are copies of each other: moved, turned about the vertical and scaled. One map does for all of them.
#pragma once

#include <cstddef>
#include <functional>
#include <string_view>
#include <vector>

#include "choice/part.h"

namespace holomorph::choice {

struct Copy {
  int first = 0;     ///< index of the part that stands for a part, which may be itself
  double scale = 1;  ///< lengths over those of that one
};

/// The copy that each part is: of the first part with the same polygons and triangles, numbered alike, whose lengths
/// and heights are the same but for one factor and the rounding of single precision. @throws Cancelled. Cost: O(#C + n
/// log n)
std::vector<Copy> copies(const std::vector<PartPointer>& parts, Execution& execution);

/// Equal for values of the same bytes.
template <class Values>
std::size_t hash_of(const Values& values) {
  const auto* bytes = reinterpret_cast<const char*>(values.data());
  return std::hash<std::string_view>()({bytes, values.size() * sizeof(values[0])});
}

}  // namespace holomorph::choice
