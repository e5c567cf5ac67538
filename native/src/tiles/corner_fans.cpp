#include "tiles/corner_fans.h"

#include "mesh/union_find.h"

namespace holomorph::tiles {

std::vector<int> corner_fans(const mesh::Surface& surface, const std::vector<char>& is_sharp) {
  const int count = static_cast<int>(surface.triangles.size());
  mesh::JoinedSets fans(3 * surface.triangles.size());
  std::vector<int> first(surface.edges.size(), -1);  // 3 t + i of the first side at each edge
  for (int s = 0; s < 3 * count; ++s) {
    const auto corner = [&](int of, int step) { return of / 3 * 3 + (of % 3 + step) % 3; };
    int& other = first[surface.triangle_edges[s / 3][s % 3]];
    if (other != -1 && !is_sharp[surface.triangle_edges[s / 3][s % 3]]) {
      fans.join(corner(s, 0), corner(other, 1));
      fans.join(corner(s, 1), corner(other, 0));
    }
    other = s;
  }
  std::vector<int> result(3 * surface.triangles.size());
  for (int s = 0; s < 3 * count; ++s) result[s] = fans.lowest(s);
  return result;
}

}  // namespace holomorph::tiles
