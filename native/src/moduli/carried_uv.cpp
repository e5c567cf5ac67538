#include "moduli/carried_uv.h"

#include <algorithm>
#include <utility>

#include "moduli/continued_charts.h"

namespace holomorph::moduli {

using Complex = std::complex<double>;

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

}  // namespace holomorph::moduli
