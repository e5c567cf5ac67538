#include "moduli/pull_back_uv.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mesh/half_edges.h"
#include "mesh/surface_walk.h"

namespace holomorph::moduli {

using Complex = std::complex<double>;

namespace {

// UVs of a surface, continued from one triangle over its neighbours.

// z -> turn z + shift
struct Similarity {
  std::complex<double> turn = 1, shift = 0;

  std::complex<double> operator()(std::complex<double> z) const { return turn * z + shift; }
  std::complex<double> inverse(std::complex<double> z) const { return (z - shift) / turn; }
  Similarity operator*(const Similarity& first) const { return {turn * first.turn, turn * first.shift + shift}; }
};

// Each triangle has a chart, its corners in the plane. From that of a first triangle they are continued, breadth
// first, across each edge by the similarity that brings its ends in both charts together.
class ContinuedCharts {
 public:
  using Corners = std::array<std::complex<double>, 3>;

  /// @param corners of each triangle. @pre the surface outlives this
  ContinuedCharts(const mesh::Surface& surface, std::vector<Corners> corners, Execution& execution);

  void begin(int triangle);

  /// A point of a triangle in the chart of the first one. @pre both are in one component
  std::complex<double> at(int triangle, const std::array<double, 3>& barycentric);

  /// Returns the similarity to that chart from the chart of the triangle in which the point lies, among the triangles
  /// visited.
  Similarity chart_at(std::complex<double> z) const;

 private:
  struct Sheet {
    int triangle;
    Similarity frame;
  };

  void add(int triangle, const Similarity& frame);
  void grow();

  std::vector<Corners> corners_;
  mesh::HalfEdges links_;
  mesh::Sides sides_;
  std::vector<int> place_;  // #T in sheets_, -1: not visited
  std::vector<Sheet> sheets_;
  std::size_t next_ = 0;
};

using Corners = ContinuedCharts::Corners;

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

ContinuedCharts::ContinuedCharts(const mesh::Surface& surface, std::vector<Corners> corners, Execution& execution)
    : corners_(std::move(corners)),
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

// p and q with to = p from + q conj(from) + constant.
std::pair<Complex, Complex> derivatives(const Corners& from, const Corners& to) {
  const Complex a = from[1] - from[0], b = from[2] - from[0], c = to[1] - to[0], d = to[2] - to[0];
  const Complex determinant = a * std::conj(b) - b * std::conj(a);
  return {(c * std::conj(b) - d * std::conj(a)) / determinant, (a * d - b * c) / determinant};
}

}  // namespace

std::vector<Complex> carried_uv(const mesh::Surface& from, const VertexImages& images, const mesh::Surface& to,
                                const std::vector<Complex>& uv, Execution& execution) {
  std::vector<ContinuedCharts::Corners> charts(to.triangles.size());
  std::transform(to.triangle_corners.begin(), to.triangle_corners.end(), charts.begin(), [&](const auto& corners) {
    return ContinuedCharts::Corners{uv[corners[0]], uv[corners[1]], uv[corners[2]]};
  });
  ContinuedCharts continued(to, std::move(charts), execution);
  const auto& [vertices, corner_vertices, face_offsets, file] = from.polygons;
  std::vector<Complex> carried(corner_vertices.size());
  for (std::size_t f = 0; f + 1 < face_offsets.size(); ++f) {
    execution.report(static_cast<double>(f) / static_cast<double>(face_offsets.size()));
    const auto begin = carried.begin() + face_offsets[f], end = carried.begin() + face_offsets[f + 1];
    continued.begin(images.triangles[corner_vertices[face_offsets[f]]]);
    std::transform(corner_vertices.begin() + face_offsets[f], corner_vertices.begin() + face_offsets[f + 1], begin,
                   [&](int v) { return continued.at(images.triangles[v], images.barycentric[v]); });
    // The polygon, in one piece over seams of the map, goes into the chart that lies under its middle.
    Complex middle = 0;
    for (auto z = begin; z != end; ++z) middle += *z / static_cast<double>(end - begin);
    const Similarity chart = continued.chart_at(middle);
    std::transform(begin, end, begin, [&](Complex z) { return chart.inverse(z); });
  }
  return carried;
}

MapDerivatives map_derivatives(const mesh::Surface& from, const VertexImages& images, const mesh::Surface& to, int sign,
                               Execution& execution) {
  std::vector<Corners> charts;
  const auto count = static_cast<int>(from.triangles.size());
  for (int t = 0; t < static_cast<int>(to.triangles.size()); ++t) charts.push_back(mesh::corners(to, t));
  ContinuedCharts unfolded(to, std::move(charts), execution);
  MapDerivatives result{std::vector<Complex>(count), std::vector<Complex>(count)};
  for (int t = 0; t < count; ++t) {
    execution.report(static_cast<double>(t) / count);
    const Corners here = mesh::corners(from, t);
    // The unfolding depends on where it begins, as the surface is curved. Of three, the one with the least dilatation
    // is taken.
    for (int start = 0; start < 3; ++start) {
      unfolded.begin(images.triangles[from.triangles[t][start]]);
      Corners there;
      for (int i = 0; i < 3; ++i) {
        const int vertex = from.triangles[t][i];
        there[i] = unfolded.at(images.triangles[vertex], images.barycentric[vertex]);
      }
      auto [p, q] = derivatives(here, there);
      if (sign < 0) std::swap(p, q);
      if (start > 0 && !(std::abs(q) * std::abs(result.p[t]) < std::abs(result.q[t]) * std::abs(p))) continue;
      result.p[t] = p;
      result.q[t] = q;
    }
  }
  return result;
}

}  // namespace holomorph::moduli
