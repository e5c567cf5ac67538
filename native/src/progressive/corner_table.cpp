#include "progressive/corner_table.h"

namespace holomorph::progressive {

CornerTable::CornerTable(std::span<const Triple> triangles, std::span<const Triple> edges, std::size_t edge_count,
                         std::size_t triangle_capacity) {
  sides_.reserve(4 * triangle_capacity);
  std::vector<int> first_side(edge_count, -1);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const int first = add(triangles[t][0], triangles[t][1], triangles[t][2]);
    for (int i = 0; i < 3; ++i) {
      int& other = first_side[static_cast<std::size_t>(edges[t][i])];
      // The second side at an edge is linked with the first. An edge with one side stays on the boundary.
      if (other < 0) {
        other = first + i;
      } else {
        link(first + i, other);
      }
    }
  }
}

int CornerTable::add(int a, int b, int c) {
  const int first = static_cast<int>(sides_.size());
  for (const int v : {a, b, c, -1}) sides_.push_back({v, -1});
  return first;
}

std::vector<int> leaving_sides(const CornerTable& table, int vertex_count) {
  std::vector<int> leaving(static_cast<std::size_t>(vertex_count), -1);
  for (int t = 0; t < table.triangle_count(); ++t) {
    for (int side = 4 * t; side < 4 * t + 3; ++side) {
      int& at = leaving[static_cast<std::size_t>(table.from(side))];
      // At the boundary the side without an opposite is kept: a walk to the left from it reaches all triangles.
      if (at < 0 || table.opposite(side) < 0) at = side;
    }
  }
  return leaving;
}

}  // namespace holomorph::progressive
