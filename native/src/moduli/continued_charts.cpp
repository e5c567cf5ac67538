#include "moduli/continued_charts.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace holomorph::moduli {
namespace {

using Complex = std::complex<double>;

/// The one that takes an edge to another; a translation where one of them is a point.
Similarity between(Complex begin, Complex end, Complex to_begin, Complex to_end) {
  if (begin == to_begin && end == to_end) return {};
  const Complex turn = (to_end - to_begin) / (end - begin);
  if (!std::isnormal(std::norm(turn))) return {1, to_begin - begin};
  return {turn, to_begin - turn * begin};
}

double cross(Complex a, Complex b) { return a.real() * b.imag() - a.imag() * b.real(); }

/// The least barycentric coordinate of a point.
double depth(const std::array<Complex, 3>& corner, Complex z) {
  const double area = cross(corner[1] - corner[0], corner[2] - corner[0]);
  double least = INFINITY;
  for (int i = 0; i < 3; ++i) {
    const Complex a = corner[i], b = corner[(i + 1) % 3];
    least = std::min(least, cross(b - a, z - a) / area);
  }
  return std::isfinite(least) ? least : -INFINITY;
}

}  // namespace

ContinuedCharts::ContinuedCharts(const mesh::Surface& surface, std::vector<Corners> corners, Execution& execution)
    : surface_(surface),
      corners_(std::move(corners)),
      links_(mesh::half_edges(surface, execution)),
      sides_(surface),
      place_(surface.triangles.size(), -1) {}

void ContinuedCharts::begin(int triangle) {
  for (const Sheet& sheet : sheets_) place_[sheet.triangle] = -1;
  sheets_.clear();
  next_ = 0;
  add(triangle, {});
}

Complex ContinuedCharts::at(int triangle, const std::array<double, 3>& barycentric) {
  while (place_[triangle] < 0) grow();
  Complex sum = 0;
  for (int i = 0; i < 3; ++i) sum += barycentric[i] * corners_[triangle][i];
  return sheets_[place_[triangle]].frame(sum);
}

Similarity ContinuedCharts::chart_at(Complex z) const {
  Similarity frame;
  double most = -INFINITY;
  for (const Sheet& sheet : sheets_) {
    const double inside = depth(corners_[sheet.triangle], sheet.frame.inverse(z));
    if (inside > most) {
      most = inside;
      frame = sheet.frame;
    }
  }
  return frame;
}

void ContinuedCharts::add(int triangle, const Similarity& frame) {
  place_[triangle] = static_cast<int>(sheets_.size());
  sheets_.push_back({triangle, frame});
}

// The neighbours of the first triangle whose neighbours have not been looked at.
void ContinuedCharts::grow() {
  const auto [triangle, frame] = sheets_[next_++];
  const Corners& here = corners_[triangle];
  for (int i = 0; i < 3; ++i) {
    const auto across = mesh::opposite(sides_(triangle, i));
    const int other = mesh::face_of(links_, across);
    if (other < 0 || place_[other] >= 0) continue;
    int j = 0;
    while (sides_(other, j) != across) ++j;
    const Corners& there = corners_[other];
    add(other, frame * between(there[(j + 1) % 3], there[j], here[i], here[(i + 1) % 3]));
  }
}

}  // namespace holomorph::moduli
