#include "uv/apexes.h"

#include <complex>

namespace holomorph::uv {

using Complex = std::complex<double>;

void place_apexes(const mesh::Surface& surface, std::span<const mesh::Star> stars, Eigen::Ref<UvArray> uv) {
  for (const mesh::Star& star : stars) {
    for (std::size_t j = 0; j < star.size(); ++j) {
      const int t = star.faces[j];
      const auto& corner = surface.triangle_corners[t];
      const auto& edge = surface.triangle_edges[t];
      int side = 0;  // the one on the link
      while (edge[side] != mesh::edge_of(star.link[j])) ++side;
      const int at_a = corner[side], at_b = corner[(side + 1) % 3], at_p = corner[(side + 2) % 3];
      const Complex a(uv(at_a, 0), uv(at_a, 1)), b(uv(at_b, 0), uv(at_b, 1)), apex = a + star.apexes[j] * (b - a);
      uv.row(at_p) << apex.real(), apex.imag();
    }
  }
}

}  // namespace holomorph::uv
