#include "moduli/map_derivatives.h"

#include <utility>

#include "mesh/surface_walk.h"
#include "moduli/continued_charts.h"

namespace holomorph::moduli {
namespace {

using Complex = std::complex<double>;
using Corners = ContinuedCharts::Corners;

// p and q with to = p from + q conj(from) + constant.
std::pair<Complex, Complex> derivatives(const Corners& from, const Corners& to) {
  const Complex a = from[1] - from[0], b = from[2] - from[0], c = to[1] - to[0], d = to[2] - to[0];
  const Complex determinant = a * std::conj(b) - b * std::conj(a);
  return {(c * std::conj(b) - d * std::conj(a)) / determinant, (a * d - b * c) / determinant};
}

}  // namespace

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
