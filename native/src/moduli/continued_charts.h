// UVs of a surface, continued from one triangle over its neighbours.
#pragma once

#include <array>
#include <complex>
#include <vector>

#include "base/execution.h"
#include "mesh/half_edges.h"
#include "mesh/surface.h"

namespace holomorph::moduli {

/// z -> turn z + shift
struct Similarity {
  std::complex<double> turn = 1, shift = 0;

  std::complex<double> operator()(std::complex<double> z) const { return turn * z + shift; }
  std::complex<double> inverse(std::complex<double> z) const { return (z - shift) / turn; }
  Similarity operator*(const Similarity& first) const { return {turn * first.turn, turn * first.shift + shift}; }
};

/// Each triangle has a chart, its corners in the plane. From that of a first triangle they are continued, breadth
/// first, across each edge by the similarity that brings its ends in both charts together.
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

  const mesh::Surface& surface_;
  std::vector<Corners> corners_;
  mesh::HalfEdges links_;
  mesh::Sides sides_;
  std::vector<int> place_;  // #T in sheets_, -1: not visited
  std::vector<Sheet> sheets_;
  std::size_t next_ = 0;
};

}  // namespace holomorph::moduli
