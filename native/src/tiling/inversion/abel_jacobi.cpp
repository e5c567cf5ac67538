#include "tiling/inversion/abel_jacobi.h"

#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <sstream>
#include <tuple>

#include "base/errors.h"
#include "forms/third_kind.h"
#include "mesh/triangle_geometry.h"

namespace holomorph::tiling {

using mesh::edge_of;
using mesh::HalfedgeHandle;
using mesh::next;
using mesh::opposite;

Jacobian::Jacobian(const PoleBasis& basis) : basis_(basis) {
  const auto& theta = basis.structure().differentials;
  MatrixXcd both(theta.rows(), 2 * theta.cols());
  both << theta, theta.conjugate();
  // theta_j and conj(theta_j) are a basis of the complex classes: X = theta c + conj(theta) t.
  split_ = linear::inverse(both);
  inverse_wedge_ = linear::inverse(MatrixXd(basis.structure().topology.pairing.cast<double>()));
  const auto& triangles = basis.surface().triangles;
  first_triangle_.assign(basis.surface().vertex_count, -1);
  for (int t = static_cast<int>(triangles.size()) - 1; t >= 0; --t) {
    for (const int v : triangles[t]) first_triangle_[v] = t;
  }
}

std::vector<int> Jacobian::triangles_at(const std::vector<int>& vertices) const {
  std::vector<int> triangles;
  for (const int v : vertices) triangles.push_back(first_triangle_[v]);
  return triangles;
}

MatrixXcd Jacobian::abel_jacobi_derivatives(const std::vector<int>& triangles) const {
  return inverse_wedge_ * basis_.derivatives(triangles).transpose();
}

// X loses r Re(D dz), D the derivative of the Abel-Jacobi map. The pairing of a class with theta_j sees its (0,1) part
// alone, and for J^-1 h(dz) it is theta_j(dz). So t depends on dz, not on its conjugate, and the real part of D is
// enough.
MatrixXcd Jacobian::tau(const std::vector<int>& triangles) const {
  const auto g = basis_.form_count();
  return -(split_.bottomRows(g) * abel_jacobi_derivatives(triangles).real().cast<Complex>());
}

MatrixXcd weighted_gram(const MatrixXcd& theta, const ArrayXd& density) {
  const ArrayXd weight = 1 / ((density + uv::kDensityFloor * density.mean()) * static_cast<double>(density.size()));
  return theta.transpose() * weight.matrix().cast<Complex>().asDiagonal() * theta.conjugate();
}

AbelJacobi::AbelJacobi(const PoleBasis& basis, Execution& execution)
    : basis_(basis),
      gram_(basis.structure().harmonic.invariants.energies.gram[0]),
      largest_(basis.harmonic().functions.cwiseAbs().maxCoeff() + 1) {
  const auto& half_edges = basis.half_edges();
  const auto count = static_cast<int>(half_edges.n_faces());
  const auto n = basis.harmonic().functions.cols();
  inverse_ = gram_.inverse().norm();
  dual_potentials_.setZero(count, n);
  rounding_.assign(count, 0.0);
  std::vector<char> reached(count, 0);
  // A tree of dual paths from triangle 0. Fluxes through edges of large weight drown in rounding, so these are crossed
  // only where there is no other way. Other edges are crossed in the order in which they are found.
  using Crossing = std::tuple<double, int, HalfedgeHandle>;
  std::priority_queue<Crossing, std::vector<Crossing>, std::greater<>> crossings;
  int seen = 0, done = 0;
  const auto reach = [&](int face) {
    reached[face] = 1;
    execution.step(done++, count);
    HalfedgeHandle h = half_edges.halfedge_handle(mesh::FaceHandle(face));
    for (int side = 0; side < 3; ++side, h = next(half_edges, h)) {
      const double weight = std::abs(basis.weights()[edge_of(h)]);
      if (!reached[mesh::face_of(half_edges, opposite(h))])
        crossings.emplace(weight > forms::kStiff ? weight : 0, seen++, h);
    }
  };
  for (reach(0); !crossings.empty();) {
    const HalfedgeHandle h = std::get<HalfedgeHandle>(crossings.top());
    crossings.pop();
    const int parent = mesh::face_of(half_edges, h), child = mesh::face_of(half_edges, opposite(h));
    if (reached[child]) continue;
    const double weight = basis.weights()[edge_of(h)];
    // Across an edge the potential of *h_j changes by the flux k h_j.
    dual_potentials_.row(child) = dual_potentials_.row(parent) + weight * along(opposite(h));
    rounding_[child] = rounding_[parent] + rounding_of(weight);
    reach(child);
  }
}

// The rounding of a flux: functions are known to half a unit in the last place.
double AbelJacobi::rounding_of(double weight) const {
  return std::numeric_limits<double>::epsilon() * std::abs(weight) * largest_;
}

Eigen::RowVectorXd AbelJacobi::along(HalfedgeHandle h) const {
  const int e = edge_of(h);
  return mesh::sign(h) * forms::edge_values(basis_.half_edges(), basis_.harmonic(), e, e + 1);
}

const VectorXd& AbelJacobi::at(int vertex) const {
  {
    const std::lock_guard lock(mutex_);
    if (const auto known = found_.find(vertex); known != found_.end()) return known->second;
  }
  VectorXd value = computed(vertex);
  const std::lock_guard lock(mutex_);
  return found_.try_emplace(vertex, std::move(value)).first->second;
}

VectorXd AbelJacobi::computed(int vertex) const {
  const auto& half_edges = basis_.half_edges();
  const auto& lengths = basis_.lengths();
  const mesh::Star star = mesh::star(half_edges, lengths, vertex);
  const forms::StarPart part = forms::star_part(half_edges, lengths, star);
  // k over the faces outside the star; `h` does not end at the pole
  const auto outer_weight = [&](HalfedgeHandle h) {
    for (const HalfedgeHandle side : {h, opposite(h)}) {
      if (mesh::to_vertex(half_edges, next(half_edges, side)) != vertex) continue;
      const HalfedgeHandle outer = opposite(side), outer1 = next(half_edges, outer);
      const double a = lengths[edge_of(outer)], b = lengths[edge_of(outer1)],
                   c = lengths[edge_of(next(half_edges, outer1))];
      return 0.5 * mesh::cotangent(a, b, c, mesh::triangle_area(a, b, c));
    }
    return basis_.weights()[edge_of(h)];
  };
  double rounding =
      rounding_[mesh::face_of(half_edges, opposite(star.link[0]))] + rounding_of(outer_weight(star.link[0]));
  // P_j = <u_s, h_j> - b_u . h_j. First the class of u_s, along the dual path from the star's link[0]; then d(u_s) on
  // the edges that leave the link; then b_u, with h_j measured from the pole.
  Eigen::RowVectorXd P = dual_potentials_.row(mesh::face_of(half_edges, opposite(star.link[0]))) +
                         outer_weight(star.link[0]) * along(star.link[0]);
  for (std::size_t j = 0; j < star.size(); ++j) {
    const HalfedgeHandle to_b = star.link[j], first = star.link[(j + 1) % star.size()];
    HalfedgeHandle h = first;  // those that leave b
    do {
      if (mesh::to_vertex(half_edges, h) != vertex) {
        const double weight = outer_weight(h) * part.u[j];
        P -= weight * along(h);
        rounding += rounding_of(weight);
      }
      h = next(half_edges, opposite(h));
    } while (h != first);
    P -= part.b_u[j] * along(opposite(next(half_edges, to_b)));
  }
  if (!(inverse_ * rounding <= forms::kEnergyError)) {
    std::ostringstream message;
    message << "rounding may change the periods of a pole at vertex " << vertex << " by " << inverse_ * rounding
            << ": triangles are too thin for double precision";
    throw SolverError(message.str());
  }
  return gram_.solve(VectorXd(P.transpose()));
}

VectorXd nearest_representative(const VectorXd& value, const VectorXd& near) {
  return value.array() + (near - value).array().round();
}

}  // namespace holomorph::tiling
