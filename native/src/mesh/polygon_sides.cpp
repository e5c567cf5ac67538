#include "mesh/polygon_sides.h"

#include <algorithm>
#include <tuple>

namespace holomorph::mesh {

std::vector<int> next_corners(const Polygons& mesh) {
  const std::vector<int>& offsets = mesh.face_offsets;
  std::vector<int> next(mesh.corner_vertices.size());
  for (std::size_t f = 0; f + 1 < offsets.size(); ++f) {
    for (int c = offsets[f]; c < offsets[f + 1]; ++c) next[c] = c + 1 == offsets[f + 1] ? offsets[f] : c + 1;
  }
  return next;
}

void for_edges(const Polygons& mesh, const std::vector<int>& label,
               const std::function<void(const LabelledSide*, const LabelledSide*)>& each) {
  const std::vector<int> next = next_corners(mesh);
  std::vector<LabelledSide> sides(label.size());
  for (int c = 0; c < static_cast<int>(label.size()); ++c) {
    sides[c] = {std::min(label[c], label[next[c]]), std::max(label[c], label[next[c]]), c};
  }
  std::sort(sides.begin(), sides.end(), [](const LabelledSide& a, const LabelledSide& b) {
    return std::tie(a.lower, a.higher, a.corner) < std::tie(b.lower, b.higher, b.corner);
  });
  const LabelledSide *const last = sides.data() + sides.size(), *end = sides.data();
  for (const LabelledSide* begin = end; begin != last; begin = end) {
    while (end != last && end->lower == begin->lower && end->higher == begin->higher) ++end;
    each(begin, end);
  }
}

std::vector<std::vector<int>> crowded_edges(const Polygons& mesh, const std::vector<int>& label) {
  std::vector<std::vector<int>> crowded;
  for_edges(mesh, label, [&](const LabelledSide* begin, const LabelledSide* end) {
    if (end - begin <= kMostFacesAtEdge) return;
    for (crowded.emplace_back(); begin != end; ++begin) crowded.back().push_back(begin->corner);
  });
  return crowded;
}

}  // namespace holomorph::mesh
