// Rectangles side by side on shelves.
#pragma once

#include <array>
#include <vector>

namespace holomorph::islands {

using Extent = std::array<double, 2>;  // along u and v

struct Shelves {
  std::vector<Extent> corners;  ///< the lower left corner of each rectangle
  Extent whole{};               ///< width and height of all
};

/// Places rectangles by falling height, ties by index, from left to right. A new row begins where the width is used up;
/// its height is that of its first one. @param gap between neighbours and between rows. Cost: n log n
Shelves on_shelves(const std::vector<Extent>& sizes, double width, double gap);

}  // namespace holomorph::islands
