#include "tiles/height_image.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace holomorph::tiles {
namespace {

using Index = Eigen::Index;

constexpr int kFewest = 3, kMost = 12;  // parts of a triangle's side, between which heights are sampled

// The pixel of `count` in which x lies; the tile is from 0 to 1, and repeats.
Index cell(double x, Index count) {
  const double turn = x - std::floor(x);
  return std::min(static_cast<Index>(turn * static_cast<double>(count)), count - 1);
}

// The two pixels whose middles x lies between, and how near it is to the second.
struct Between {
  Index first, second;
  double part;
};

Between between(double x, Index count) {
  const double place = (x - std::floor(x)) * static_cast<double>(count) - 0.5, low = std::floor(place);
  const Index first = (static_cast<Index>(low) + count) % count;
  return {first, first + 1 == count ? 0 : first + 1, place - low};
}

// The highest of each pixel and its neighbours.
HeightImage::Pixels widened(const HeightImage::Pixels& pixels) {
  const Index rows = pixels.rows(), columns = pixels.cols();
  HeightImage::Pixels wide = pixels, result = pixels;
  for (const Index d : {Index{1}, columns - 1}) {
    for (Index j = 0; j < columns; ++j) wide.col(j) = wide.col(j).max(pixels.col((j + d) % columns));
  }
  result = wide;
  for (const Index d : {Index{1}, rows - 1}) {
    for (Index i = 0; i < rows; ++i) result.row(i) = result.row(i).max(wide.row((i + d) % rows));
  }
  return result;
}

double middle(Index i, Index count) { return (static_cast<double>(i) + 0.5) / static_cast<double>(count); }

}  // namespace

HeightImage::HeightImage(Pixels pixels) {
  levels_.push_back({std::move(pixels), {}, {}});
  while (levels_.back().mean.size() > 1) {
    Level coarse = halved(levels_.back());
    levels_.back().rest = {};  // of which `around` is left
    levels_.push_back(std::move(coarse));
  }
}

double HeightImage::rest(const Point& tile, int level) const {
  const Pixels& values = levels_[level].around;
  return values(cell(tile[1], values.rows()), cell(tile[0], values.cols()));
}

double HeightImage::error(const HeightTriangle& t, double level, double finest) const {
  if (t.shares == std::array{0.0, 0.0, 0.0}) return 0;
  double longest = 0;  // in pixels
  for (int i = 0; i < 3; ++i) {
    const Point &from = t.tiles[i], &to = t.tiles[(i + 1) % 3];
    longest = std::max(longest, std::hypot((to[0] - from[0]) * columns(), (to[1] - from[1]) * rows()));
  }
  if (longest < finest) return 0;
  const int parts = static_cast<int>(std::clamp(std::ceil(longest) + 1, double{kFewest}, double{kMost}));
  const double step = longest / parts;
  const int depth = step <= 1 ? 0 : std::min(std::ilogb(step) + 1, level_count() - 1);
  double error = 0;
  for (int i = 0; i <= parts; ++i) {
    for (int j = 0; i + j <= parts; ++j) {
      const double y = static_cast<double>(i) / parts, z = static_cast<double>(j) / parts, x = 1 - y - z;
      const auto linear = [=](double a, double b, double c) { return x * a + y * b + z * c; };
      const Point place{linear(t.tiles[0][0], t.tiles[1][0], t.tiles[2][0]),
                        linear(t.tiles[0][1], t.tiles[1][1], t.tiles[2][1])};
      const double share = linear(t.shares[0], t.shares[1], t.shares[2]);
      const double flat = linear(t.heights[0], t.heights[1], t.heights[2]);
      const double off = std::abs(share * (at(place, depth) - level) - flat);
      error = std::max(error, off + (depth > 0 ? share * rest(place, depth) : 0));
    }
  }
  return error;
}

double HeightImage::bilinear(const Pixels& pixels, double u, double v) {
  const Between x = between(u, pixels.cols()), y = between(v, pixels.rows());
  const double low = std::lerp(pixels(y.first, x.first), pixels(y.first, x.second), x.part);
  const double high = std::lerp(pixels(y.second, x.first), pixels(y.second, x.second), x.part);
  return std::lerp(low, high, y.part);
}

HeightImage::Level HeightImage::halved(const Level& fine) {
  const Index rows = (fine.mean.rows() + 1) / 2, columns = (fine.mean.cols() + 1) / 2;
  Level coarse{Pixels(rows, columns), Pixels::Zero(rows, columns), {}};
  const double x = 0.25 / static_cast<double>(columns), y = 0.25 / static_cast<double>(rows);
  for (Index i = 0; i < rows; ++i) {
    for (Index j = 0; j < columns; ++j) {
      const double u = middle(j, columns), v = middle(i, rows);
      // The mean of the fine image at four points of the pixel. An odd number of pixels is no obstacle.
      coarse.mean(i, j) = (bilinear(fine.mean, u - x, v - y) + bilinear(fine.mean, u + x, v - y) +
                           bilinear(fine.mean, u - x, v + y) + bilinear(fine.mean, u + x, v + y)) /
                          4;
    }
  }
  for (Index i = 0; i < fine.mean.rows(); ++i) {
    for (Index j = 0; j < fine.mean.cols(); ++j) {
      const double u = middle(j, fine.mean.cols()), v = middle(i, fine.mean.rows());
      // The error of the fine level, plus that of the coarse level against the fine one, at the middle of each fine
      // pixel.
      double& rest = coarse.rest(cell(v, rows), cell(u, columns));
      const double lost = fine.rest.size() == 0 ? 0 : fine.rest(i, j);
      rest = std::max(rest, lost + std::abs(fine.mean(i, j) - bilinear(coarse.mean, u, v)));
    }
  }
  coarse.around = widened(coarse.rest);
  return coarse;
}

}  // namespace holomorph::tiles
