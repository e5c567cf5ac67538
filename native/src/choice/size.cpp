#include "choice/size.h"

#include <algorithm>
#include <utility>

namespace holomorph::choice {

Window best_window(const std::vector<Sizes>& parts) {
  std::vector<Window> tried{window_around()};
  for (const Sizes& part : parts) {
    for (const double size : part.densities) {
      if (1 / kLikeSize <= size && size <= 1) tried.push_back(window_from(size));
    }
  }
  for (const Sizes& part : parts) {
    for (const double size : part.densities) {
      if (1 <= size && size <= kLikeSize) tried.push_back(window_from(size / kLikeSize));
    }
  }
  return *std::ranges::max_element(tried, {}, [&](const Window& window) {
    double held = 0;
    for (const Sizes& part : parts) {
      if (std::ranges::any_of(part.densities, [&](double size) { return window.holds(size); })) held += part.weight;
    }
    return std::pair(held, -std::abs(std::log(window.low * window.high)));
  });
}

MapPointer nearest(const std::vector<MapPointer>& maps, double density) {
  const auto off = [&](const MapPointer& made) { return std::abs(relative_size(*made, density) - 1); };
  return *std::ranges::min_element(maps, {}, off);
}

}  // namespace holomorph::choice
