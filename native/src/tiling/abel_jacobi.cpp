#include "tiling/abel_jacobi.h"

#include <Eigen/Cholesky>

#include "forms/singular_part.h"
#include "mesh/triangle_geometry.h"

namespace holomorph::tiling {

using mesh::edge_of;
using mesh::HalfedgeHandle;
using mesh::next;
using mesh::opposite;

AbelJacobi::AbelJacobi(const Landscape& landscape, Execution& execution) : landscape_(landscape) {
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
      dual_potentials_.row(child) =
          dual_potentials_.row(parent) + landscape.weights()[edge_of(h)] * along(opposite(h));
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
  const std::vector<mesh::Star> stars = mesh::stars(mesh, lengths, {vertex});
  const mesh::Star& star = stars[0];
  const forms::SingularPart part = forms::singular_part(mesh, lengths, stars);
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
  for (const HalfedgeHandle link : star.link) {
    const int a = mesh::from_vertex(mesh, link);
    HalfedgeHandle h = link;
    do {
      if (mesh::to_vertex(mesh, h) != vertex) P -= outer_weight(h) * part.u.coeff(a, 0) * along(h);
      h = next(mesh, opposite(h));
    } while (h != link);
    P -= part.b_u.coeff(mesh::to_vertex(mesh, link), 0) * along(opposite(next(mesh, link)));
  }
  return landscape_.structure().gram[0].llt().solve(P.transpose());
}

Eigen::VectorXd nearest_representative(const Eigen::VectorXd& value, const Eigen::VectorXd& near) {
  return value.array() + (near - value).array().round();
}

}  // namespace holomorph::tiling
