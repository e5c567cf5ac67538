#include "structure/structure.h"

#include <algorithm>

#include "base/finite.h"
#include "uv/apexes.h"

namespace holomorph::structure {

void write_uv_map(const Structure& s, const uv::UvArray& function, const Eigen::VectorXcd& p,
                  Eigen::Ref<uv::UvArray> corners, Workers& workers) {
  uv::write_uv_map(*s.surface, s.topology.sheets, function, p, corners, workers);
  // At a pole the function is infinite: the triangles of its star get apexes in the plane.
  uv::place_apexes(*s.surface, s.stars(), corners);
  require_finite(corners, "corner", workers);
}

double uv_area(const Structure& s, const Eigen::VectorXcd& p) {
  // du and dv = *du have the same energy, and int du ^ dv is that energy.
  const auto& G = s.holomorphic().star.natural_gram;
  const Eigen::VectorXd r = p.head(G.rows()).real();
  return r.dot(G * r);
}

Structure cut_along(Structure s, std::vector<int> edges, const std::vector<int>& labels, Execution& execution) {
  // In the star of a pole the triangles have no common image: its spokes are seams in any case.
  const std::vector<int> also = spokes(s);
  edges.insert(edges.end(), also.begin(), also.end());
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  const auto half_edges = mesh::half_edges(*s.surface, execution);
  s.topology.sheets = uv::corner_sheets(*s.surface, half_edges, edges, s.topology.classes, execution, labels);
  s.topology.seams = std::move(edges);
  return s;
}

std::vector<int> spokes(const Structure& s) {
  std::vector<int> edges;
  for (const mesh::Star& star : s.stars()) {
    for (const int t : star.faces) {
      for (const int e : s.surface->triangle_edges[t]) {
        const auto [a, b] = s.surface->edges[e];
        if (a == star.vertex || b == star.vertex) edges.push_back(e);
      }
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

}  // namespace holomorph::structure
