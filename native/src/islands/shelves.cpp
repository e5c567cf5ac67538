#include "islands/shelves.h"

#include <algorithm>
#include <numeric>

namespace holomorph::islands {

Shelves on_shelves(const std::vector<Extent>& sizes, double width, double gap) {
  std::vector<std::size_t> order(sizes.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return sizes[a][1] > sizes[b][1]; });
  Shelves result{std::vector<Extent>(sizes.size()), {}};
  double x = 0, y = 0, height = 0;
  for (const std::size_t i : order) {
    const auto& [w, h] = sizes[i];
    if (x > 0 && x + w > width) {
      x = 0;
      y = y + height + gap;
      height = 0;
    }
    result.corners[i] = {x, y};
    result.whole[0] = std::max(result.whole[0], x + w);
    height = std::max(height, h);
    x += w + gap;
  }
  result.whole[1] = y + height;
  return result;
}

}  // namespace holomorph::islands
