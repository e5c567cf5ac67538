#include "moduli/carried_uv.h"

#include <algorithm>
#include <cmath>

#include "mesh/half_edges.h"

namespace holomorph::moduli {
namespace {

using Complex = std::complex<double>;

/// z -> turn z + shift
struct Similarity {
  Complex turn = 1, shift = 0;

  Complex operator()(Complex z) const { return turn * z + shift; }
  Complex inverse(Complex z) const { return (z - shift) / turn; }
  Similarity operator*(const Similarity& first) const { return {turn * first.turn, turn * first.shift + shift}; }
};

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

/// UVs of a surface, continued from a triangle over its neighbours.
class ContinuedUv {
 public:
  ContinuedUv(const mesh::Surface& surface, const std::vector<Complex>& uv, Execution& execution)
      : surface_(surface),
        uv_(uv),
        links_(mesh::half_edges(surface, execution)),
        sides_(surface),
        place_(surface.triangles.size(), -1) {}

  void begin(int triangle) {
    for (const Sheet& sheet : sheets_) place_[sheet.triangle] = -1;
    sheets_.clear();
    next_ = 0;
    add(triangle, {});
  }

  /// In the chart of the triangle of the beginning.
  Complex at(int triangle, const std::array<double, 3>& barycentric) {
    while (place_[triangle] < 0) grow();
    const auto corner = corners(triangle);
    Complex sum = 0;
    for (int i = 0; i < 3; ++i) sum += barycentric[i] * corner[i];
    return sheets_[place_[triangle]].frame(sum);
  }

  /// Into that chart from the one of the triangle, of those that were come by, in which the point lies.
  Similarity chart_at(Complex z) const {
    Similarity frame;
    double most = -INFINITY;
    for (const Sheet& sheet : sheets_) {
      const double inside = depth(corners(sheet.triangle), sheet.frame.inverse(z));
      if (inside > most) {
        most = inside;
        frame = sheet.frame;
      }
    }
    return frame;
  }

 private:
  struct Sheet {
    int triangle;
    Similarity frame;
  };

  std::array<Complex, 3> corners(int triangle) const {
    const auto [a, b, c] = surface_.triangle_corners[triangle];
    return {uv_[a], uv_[b], uv_[c]};
  }

  void add(int triangle, const Similarity& frame) {
    place_[triangle] = static_cast<int>(sheets_.size());
    sheets_.push_back({triangle, frame});
  }

  // The neighbours of the first triangle whose neighbours have not been looked at: breadth first.
  void grow() {
    const auto [triangle, frame] = sheets_[next_++];
    const auto here = corners(triangle);
    for (int i = 0; i < 3; ++i) {
      const auto across = mesh::opposite(sides_(triangle, i));
      const int other = mesh::face_of(links_, across);
      if (other < 0 || place_[other] >= 0) continue;
      int j = 0;
      while (sides_(other, j) != across) ++j;
      const auto there = corners(other);
      add(other, frame * between(there[(j + 1) % 3], there[j], here[i], here[(i + 1) % 3]));
    }
  }

  const mesh::Surface& surface_;
  const std::vector<Complex>& uv_;
  mesh::HalfEdges links_;
  mesh::Sides sides_;
  std::vector<int> place_;  // #T in sheets_, -1: not come by
  std::vector<Sheet> sheets_;
  std::size_t next_ = 0;
};

}  // namespace

std::vector<Complex> carried_uv(const mesh::Surface& from, const VertexImages& images, const mesh::Surface& to,
                                const std::vector<Complex>& uv, Execution& execution) {
  ContinuedUv continued(to, uv, execution);
  const auto& [vertices, corner_vertices, face_offsets] = from.polygons;
  std::vector<Complex> carried(corner_vertices.size());
  for (std::size_t f = 0; f + 1 < face_offsets.size(); ++f) {
    execution.report(static_cast<double>(f) / static_cast<double>(face_offsets.size()));
    const auto begin = carried.begin() + face_offsets[f], end = carried.begin() + face_offsets[f + 1];
    continued.begin(images.triangles[corner_vertices[face_offsets[f]]]);
    std::transform(corner_vertices.begin() + face_offsets[f], corner_vertices.begin() + face_offsets[f + 1], begin,
                   [&](int v) { return continued.at(images.triangles[v], images.barycentric[v]); });
    Complex middle = 0;
    for (auto z = begin; z != end; ++z) middle += *z / static_cast<double>(end - begin);
    const Similarity chart = continued.chart_at(middle);
    std::transform(begin, end, begin, [&](Complex z) { return chart.inverse(z); });
  }
  return carried;
}

}  // namespace holomorph::moduli
