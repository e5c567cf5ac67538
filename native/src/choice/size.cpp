#include "choice/size.h"

#include <algorithm>
#include <utility>

#include "base/errors.h"

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
  const auto weight = [&](const Window& window) {
    double all = 0;
    for (const Sizes& part : parts) {
      if (std::ranges::any_of(part.densities, [&](double size) { return window.holds(size); })) all += part.weight;
    }
    return std::pair(all, -std::abs(std::log(window.low * window.high)));
  };
  return held(std::ranges::max_element(tried, {}, weight), tried);
}

MapPointer nearest(const std::vector<MapPointer>& maps, double density) {
  const auto off = [&](const MapPointer& made) { return std::abs(relative_size(*made, density) - 1); };
  return held(std::ranges::min_element(maps, {}, off), maps);
}

}  // namespace holomorph::choice
