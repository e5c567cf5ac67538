#include "flat/shelves.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace holomorph::flat {
namespace {

constexpr int kWidths = 24;       // tried, from the square of the total area upwards
constexpr double kWidest = 2;     // the largest of these widths, in sides of that square
constexpr double kMostGap = 0.3;  // share of the side for all gaps of a row
// The gap is a share of a side that depends on the gap; each round leaves a few per cent of the error.
constexpr int kGapRounds = 4;

double longer(const Shelves& shelves) { return std::max(shelves.whole[0], shelves.whole[1]); }

// The first of the widths that gives the smallest square.
Shelves best_rows(const std::vector<Extent>& sizes, double gap) {
  double area = 0, widest = 0;
  for (const auto& [w, h] : sizes) {
    area += (w + gap) * (h + gap);
    widest = std::max(widest, w);
  }
  const double square = std::max(std::sqrt(area), widest);
  Shelves best = on_shelves(sizes, square, gap);
  for (int k = 1; k < kWidths; ++k) {
    const double share = static_cast<double>(k) / (kWidths - 1);
    Shelves made = on_shelves(sizes, square * std::pow(kWidest, share), gap);
    if (longer(made) < longer(best)) best = std::move(made);
  }
  return best;
}

}  // namespace

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

Packing pack(const std::vector<Extent>& sizes, double margin) {
  const auto is_point = [](const Extent& size) { return size[0] == 0 && size[1] == 0; };
  if (std::ranges::all_of(sizes, is_point)) return {std::vector<Extent>(sizes.size(), Extent{}), 0};
  margin = fitting_margin(margin, sizes.size());
  Shelves shelves = best_rows(sizes, 0);
  for (int round = 0; sizes.size() > 1 && round < kGapRounds; ++round)
    shelves = best_rows(sizes, margin * longer(shelves));
  Packing result{std::move(shelves.corners), longer(shelves)};
  for (Extent& corner : result.corners) {
    for (int i = 0; i < 2; ++i) corner[i] += (result.side - shelves.whole[i]) / 2;
  }
  return result;
}

double fitting_margin(double margin, std::size_t count) {
  return std::min(margin, kMostGap / std::sqrt(static_cast<double>(count)));
}

}  // namespace holomorph::flat
