#include "flat/arrangement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numeric>
#include <utility>

#include "base/constants.h"

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

constexpr Complex kCentre(0.5, 0.5);  // the middle of the UV square
constexpr int kSingleBits = 24;       // bits of the mantissa of single precision, which applications store

// Less where a map is scattered, as by triangles without area between its others; 0 without area.
double scale_of(const Laid& map, const uv::Frame& frame) {
  if (!(map.density > 0)) return frame.area > 0 ? std::sqrt(map.area / frame.area) : 0;
  const Complex size = frame.high - frame.low;
  const double longer = std::max(size.real(), size.imag());
  const double most = longer > 0 ? kScattered * std::sqrt(map.area) / longer : kInfinity;
  return std::min(std::pow(map.density, -0.5), most);
}

// The length on the surface of a unit of tilings.
double unit_of(const std::vector<Laid>& tiled) {
  std::vector<double> densities;
  for (const Laid& map : tiled) densities.push_back(map.density);
  std::ranges::sort(densities);
  const double median = (densities[(densities.size() - 1) / 2] + densities[densities.size() / 2]) / 2;
  return median > 0 ? 1 / std::sqrt(median) : 0;
}

// The tilings, and other maps.
std::pair<std::vector<Laid>, std::vector<Laid>> by_kind(const std::vector<Laid>& maps) {
  std::pair<std::vector<Laid>, std::vector<Laid>> result;
  for (const Laid& map : maps) (map.is_tiled ? result.first : result.second).push_back(map);
  return result;
}

int row_of(const Laid& map, int corner) { return map.corner_index ? map.corner_index[corner] : corner; }

Extent turned(const Extent& uv, int quarters) {
  switch (quarters & 3) {
    case 1:
      return {-uv[1], uv[0]};
    case 2:
      return {-uv[0], -uv[1]};
    case 3:
      return {uv[1], -uv[0]};
    default:
      return uv;
  }
}

// The whole units in which a tiling lies, turned.
struct Units {
  Extent step{1, 1};  // shifts by whole hexagons alone keep sixth turns
  Extent low, size;
};

Units units_of(const Laid& map, int quarters) {
  Units result;
  if (map.turns == 6) result.step[1] = std::sqrt(3.0);
  const Extent a = turned({map.uv.col(0).minCoeff(), map.uv.col(1).minCoeff()}, quarters);
  const Extent b = turned({map.uv.col(0).maxCoeff(), map.uv.col(1).maxCoeff()}, quarters);
  for (int i = 0; i < 2; ++i) {
    const double step = result.step[i];
    result.low[i] = std::floor(std::min(a[i], b[i]) / step) * step;
    result.size[i] = std::ceil(std::max(a[i], b[i]) - result.low[i] + step - 1);
  }
  return result;
}

// Tilings side by side, on shelves of whole units.
void write_tilings(const std::vector<Laid>& tiled, int quarters, uv::UvArray& placed, Workers& workers) {
  std::vector<Units> units;
  std::vector<Extent> sizes;
  double area = 0, widest = 0;
  for (const Laid& map : tiled) {
    units.push_back(units_of(map, quarters));
    sizes.push_back(units.back().size);
    area += sizes.back()[0] * sizes.back()[1];
    widest = std::max(widest, sizes.back()[0]);
  }
  const Shelves shelves = on_shelves(sizes, std::max(std::ceil(std::sqrt(area)), widest), 0);
  for (std::size_t k = 0; k < tiled.size(); ++k) {
    const auto& [step, low, size] = units[k];
    Extent shift;
    for (int i = 0; i < 2; ++i) shift[i] = std::ceil(shelves.corners[k][i] / step[i]) * step[i] - low[i];
    const Laid& map = tiled[k];
    for_rows(workers, static_cast<int>(map.uv.rows()), [&](int c) {
      const Extent at = turned({map.uv(c, 0), map.uv(c, 1)}, quarters);
      placed.row(row_of(map, c)) << at[0] + shift[0], at[1] + shift[1];
    });
  }
}

// Other maps to the right of tilings, at their texel density, in a square that stands on v = 0.
void write_beside(const std::vector<Laid>& rest, double unit, Arrangement arrangement, uv::UvArray& placed,
                  Workers& workers) {
  arrangement.density = 1;
  arrangement.per_length = unit > 0 ? 1 / unit : 0;
  const Square square(rest, arrangement, workers);
  uv::UvArray values(placed.rows(), 2);
  square.write(rest, values.data(), workers);
  const double side = square.per_length() / square.filling(), low = kCentre.real() - side / 2;
  const double right = std::ceil(placed.col(0).maxCoeff());
  const auto u = static_cast<float>(right + arrangement.margin * side - low), v = static_cast<float>(-low);
  for (const Laid& map : rest) {
    for_rows(workers, static_cast<int>(map.uv.rows()), [&](int c) {
      const int row = row_of(map, c);
      placed.row(row) << static_cast<float>(values(row, 0)) + u, static_cast<float>(values(row, 1)) + v;
    });
  }
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

Square::Square(const std::vector<Laid>& maps, const Arrangement& arrangement, Workers& workers)
    : arrangement_(arrangement) {
  for (const Laid& map : maps) {
    frames_.push_back(uv::frame(*map.surface, map.uv, arrangement.rotation, workers));
    scales_.push_back(scale_of(map, frames_.back()));
    const Complex size = frames_.back().high - frames_.back().low;
    sizes_.push_back({scales_.back() * size.real(), scales_.back() * size.imag()});
  }
  packed_ = pack(sizes_, arrangement.margin);
}

double Square::filling() const { return packed_.side > 0 ? 1 / packed_.side : kInfinity; }

double Square::used() const {
  double covered = 0;
  for (std::size_t k = 0; k < frames_.size(); ++k) covered += frames_[k].area * (scales_[k] * scales_[k]);
  return packed_.side > 0 ? covered / (packed_.side * packed_.side) : 0;
}

double Square::per_length() const {
  if (!(packed_.side > 0)) return 0;
  return arrangement_.density * (arrangement_.per_length != 0 ? arrangement_.per_length : filling());
}

void Square::write(const std::vector<Laid>& maps, double* placed, Workers& workers) const {
  const Complex middle = Complex(packed_.side, packed_.side) / 2.0;
  const Complex turn = std::polar(1.0, arrangement_.rotation), back = std::polar(1.0, -arrangement_.rotation);
  for (std::size_t k = 0; k < maps.size(); ++k) {
    const auto complex = [](const Extent& extent) { return Complex(extent[0], extent[1]); };
    const Complex origin = (frames_[k].low + frames_[k].high) / 2.0 * back;
    const Complex offset = complex(packed_.corners[k]) + complex(sizes_[k]) / 2.0 - middle;
    uv::place(maps[k].uv, {per_length() * scales_[k] * turn, origin, kCentre + per_length() * offset},
              maps[k].corner_index, placed, workers);
  }
}

void round_to_grid(Eigen::Ref<uv::UvArray> uv) {
  int exponent = 0;
  std::frexp(uv.size() == 0 ? 1.0 : std::max(uv.cwiseAbs().maxCoeff(), 1.0), &exponent);
  const double step = std::ldexp(1.0, exponent - kSingleBits);
  // Ties go to even ones: the same on both sides of a turn.
  uv = uv.unaryExpr([&](double value) { return std::nearbyint(value / step) * step; });
}

uv::UvArray arranged(const std::vector<Laid>& maps, int corners, const Arrangement& arrangement, Workers& workers) {
  uv::UvArray placed = uv::UvArray::Zero(corners, 2);
  const auto [tiled, rest] = by_kind(maps);
  if (tiled.empty()) {
    Square(rest, arrangement, workers).write(rest, placed.data(), workers);
    return placed;
  }
  write_tilings(tiled, arrangement.quarters, placed, workers);
  round_to_grid(placed);
  if (!rest.empty()) write_beside(rest, unit_of(tiled), arrangement, placed, workers);
  return placed;
}

double unit_length(const std::vector<Laid>& maps, const Arrangement& arrangement, Workers& workers) {
  const auto [tiled, rest] = by_kind(maps);
  if (!tiled.empty()) return unit_of(tiled);
  const double wanted = Square(rest, arrangement, workers).per_length();
  return wanted > 0 ? 1 / wanted : 0;
}

}  // namespace holomorph::flat
