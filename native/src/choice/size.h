// How large squares are: what is wanted, and how far whole tiles may miss it.
#pragma once

#include <cmath>
#include <vector>

#include "choice/map.h"

namespace holomorph::choice {

/// Largest over smallest median density of tilings, for parts whose squares have one size.
inline constexpr double kLikeSize = 1.095;
inline constexpr int kTries = 4;  ///< numbers of tiles, until the median density is the wanted one

/// The least and the largest median density, over the wanted one.
struct Window {
  double low = 1, high = 1;

  bool holds(double size) const { return low <= size && size <= high; }
};

/// The window from `low` on.
inline Window window_from(double low) { return {low, low * kLikeSize}; }
/// The one in whose middle the wanted density is.
inline Window window_around() { return window_from(1 / std::sqrt(kLikeSize)); }

/// The sizes that a part may have.
struct Sizes {
  std::vector<double> densities;  ///< median ones of its maps, over the wanted one
  double weight = 0;              ///< its area
};

/// The window with the wanted density, 1, that holds one of the sizes of most parts by their weights; of equal ones the
/// one whose middle is nearest to it.
Window best_window(const std::vector<Sizes>& parts);

/// The median density over the wanted one.
inline double relative_size(const Map& made, double density) { return density > 0 ? made.density() / density : 1; }

/// The map whose median density is nearest to the wanted one; the first of equals. @pre there is one
MapPointer nearest(const std::vector<MapPointer>& maps, double density);

}  // namespace holomorph::choice
