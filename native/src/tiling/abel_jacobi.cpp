#include "tiling/abel_jacobi.h"

#include "forms/singular_part.h"
#include "mesh/triangle_geometry.h"

namespace holomorph::tiling {

using mesh::edge_of;
using mesh::HalfedgeHandle;
using mesh::next;
using mesh::opposite;

AbelJacobi::AbelJacobi(const Landscape& landscape, Execution& execution)
    : landscape_(landscape), gram_(landscape.structure().gram[0]) {
  const auto& mesh = landscape.half_edges();
  const auto count = static_cast<int>(mesh.n_faces());
  dual_potentials_.setZero(count, landscape.harmonic().functions.cols());
  std::vector<char> reached(count, 0);
  std::vector<int> queue{0};
  reached[0] = 1;
  for (std::size_t i = 0; i < queue.size(); ++i) {
    execution.step(i, count);
    const int parent = queue[i];
    HalfedgeHandle h = mesh.halfedge_handle(mesh::FaceHandle(parent));
    for (int side = 0; side < 3; ++side, h = next(mesh, h)) {
      const int child = mesh::face_of(mesh, opposite(h));
      if (reached[child]) continue;
      reached[child] = 1;
      queue.push_back(child);
      dual_potentials_.row(child) = dual_potentials_.row(parent) + landscape.weights()[edge_of(h)] * along(opposite(h));
    }
  }
}

Eigen::RowVectorXd AbelJacobi::along(HalfedgeHandle h) const {
  const int e = edge_of(h);
  return mesh::sign(h) * forms::edge_values(landscape_.half_edges(), landscape_.harmonic(), e, e + 1);
}

Eigen::VectorXd AbelJacobi::at(int vertex) const {
  const auto& mesh = landscape_.half_edges();
  const auto& lengths = landscape_.lengths();
  const mesh::Star star = mesh::star(mesh, lengths, vertex);
  const forms::StarPart part = forms::star_part(mesh, lengths, star);
  // k over the faces outside the star; `h` does not end at the puncture
  const auto outer_weight = [&](HalfedgeHandle h) {
    for (const HalfedgeHandle side : {h, opposite(h)}) {
      if (mesh::to_vertex(mesh, next(mesh, side)) != vertex) continue;
      const HalfedgeHandle outer = opposite(side), outer1 = next(mesh, outer);
      const double a = lengths[edge_of(outer)], b = lengths[edge_of(outer1)], c = lengths[edge_of(next(mesh, outer1))];
      return 0.5 * mesh::cotangent(a, b, c, mesh::triangle_area(a, b, c));
    }
    return landscape_.weights()[edge_of(h)];
  };
  Eigen::RowVectorXd P = dual_potentials_.row(mesh::face_of(mesh, opposite(star.link[0]))) +
                         outer_weight(star.link[0]) * along(star.link[0]);
  for (std::size_t j = 0; j < star.size(); ++j) {
    const HalfedgeHandle to_b = star.link[j], first = star.link[(j + 1) % star.size()];
    HalfedgeHandle h = first;  // those that leave b
    do {
      if (mesh::to_vertex(mesh, h) != vertex) P -= outer_weight(h) * part.u[j] * along(h);
      h = next(mesh, opposite(h));
    } while (h != first);
    P -= part.b_u[j] * along(opposite(next(mesh, to_b)));
  }
  return gram_.solve(P.transpose());
}

Eigen::VectorXd nearest_representative(const Eigen::VectorXd& value, const Eigen::VectorXd& near) {
  return value.array() + (near - value).array().round();
}

}  // namespace holomorph::tiling
