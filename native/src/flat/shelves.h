// Rectangles side by side on shelves.
#pragma once

#include <array>
#include <vector>

namespace holomorph::flat {

using Extent = std::array<double, 2>;  // along u and v

struct Shelves {
  std::vector<Extent> corners;  ///< the lower left corner of each rectangle
  Extent whole{};               ///< width and height of all
};

/// Places rectangles by falling height, ties by index, from left to right. A new row begins where the width is used up;
/// its height is that of its first one. @param gap between neighbours and between rows. Cost: n log n
Shelves on_shelves(const std::vector<Extent>& sizes, double width, double gap);

struct Packing {
  std::vector<Extent> corners;  ///< the lower left corner of each rectangle
  double side = 0;              ///< of the square in which they lie, centred
};

/// Places rectangles in the smallest square that one of a fixed set of widths gives. Nothing is turned, so that
/// straight boundaries stay level. Points lie at 0.
/// @param margin distance of neighbours, as a share of the side; less where so many parts would have no room
Packing pack(const std::vector<Extent>& sizes, double margin);

/// The margin, or the largest one for which this number of parts has room.
double fitting_margin(double margin, std::size_t count);

}  // namespace holomorph::flat
