#include "tiling/abel_jacobi.h"

#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <sstream>
#include <tuple>

#include "base/errors.h"
#include "forms/singular_part.h"
#include "mesh/triangle_geometry.h"

namespace holomorph::tiling {

using mesh::edge_of;
using mesh::HalfedgeHandle;
using mesh::next;
using mesh::opposite;

AbelJacobi::AbelJacobi(const Landscape& landscape, Execution& execution)
    : landscape_(landscape),
      gram_(landscape.structure().harmonic.invariants.energies.gram[0]),
      largest_(landscape.harmonic().functions.cwiseAbs().maxCoeff() + 1) {
  const auto& mesh = landscape.half_edges();
  const auto count = static_cast<int>(mesh.n_faces());
  const auto n = landscape.harmonic().functions.cols();
  inverse_ = gram_.solve(Eigen::MatrixXd::Identity(n, n)).norm();
  dual_potentials_.setZero(count, n);
  rounding_.assign(count, 0.0);
  std::vector<char> reached(count, 0);
  // Fluxes through edges of large weight drown in rounding: these are crossed where there is no other way. The others
  // in the order in which they are come upon.
  using Crossing = std::tuple<double, int, HalfedgeHandle>;
  std::priority_queue<Crossing, std::vector<Crossing>, std::greater<>> crossings;
  int seen = 0, done = 0;
  const auto reach = [&](int face) {
    reached[face] = 1;
    execution.step(done++, count);
    HalfedgeHandle h = mesh.halfedge_handle(mesh::FaceHandle(face));
    for (int side = 0; side < 3; ++side, h = next(mesh, h)) {
      const double weight = std::abs(landscape.weights()[edge_of(h)]);
      if (!reached[mesh::face_of(mesh, opposite(h))]) crossings.emplace(weight > forms::kStiff ? weight : 0, seen++, h);
    }
  };
  for (reach(0); !crossings.empty();) {
    const HalfedgeHandle h = std::get<HalfedgeHandle>(crossings.top());
    crossings.pop();
    const int parent = mesh::face_of(mesh, h), child = mesh::face_of(mesh, opposite(h));
    if (reached[child]) continue;
    const double weight = landscape.weights()[edge_of(h)];
    dual_potentials_.row(child) = dual_potentials_.row(parent) + weight * along(opposite(h));
    rounding_[child] = rounding_[parent] + rounding_of(weight);
    reach(child);
  }
}

// Of a flux: functions are known to half a unit in the last place.
double AbelJacobi::rounding_of(double weight) const {
  return std::numeric_limits<double>::epsilon() * std::abs(weight) * largest_;
}

Eigen::RowVectorXd AbelJacobi::along(HalfedgeHandle h) const {
  const int e = edge_of(h);
  return mesh::sign(h) * forms::edge_values(landscape_.half_edges(), landscape_.harmonic(), e, e + 1);
}

const Eigen::VectorXd& AbelJacobi::at(int vertex) const {
  {
    const std::lock_guard lock(mutex_);
    if (const auto known = found_.find(vertex); known != found_.end()) return known->second;
  }
  Eigen::VectorXd value = computed(vertex);
  const std::lock_guard lock(mutex_);
  return found_.try_emplace(vertex, std::move(value)).first->second;
}

Eigen::VectorXd AbelJacobi::computed(int vertex) const {
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
  double rounding = rounding_[mesh::face_of(mesh, opposite(star.link[0]))] + rounding_of(outer_weight(star.link[0]));
  Eigen::RowVectorXd P = dual_potentials_.row(mesh::face_of(mesh, opposite(star.link[0]))) +
                         outer_weight(star.link[0]) * along(star.link[0]);
  for (std::size_t j = 0; j < star.size(); ++j) {
    const HalfedgeHandle to_b = star.link[j], first = star.link[(j + 1) % star.size()];
    HalfedgeHandle h = first;  // those that leave b
    do {
      if (mesh::to_vertex(mesh, h) != vertex) {
        const double weight = outer_weight(h) * part.u[j];
        P -= weight * along(h);
        rounding += rounding_of(weight);
      }
      h = next(mesh, opposite(h));
    } while (h != first);
    P -= part.b_u[j] * along(opposite(next(mesh, to_b)));
  }
  if (!(inverse_ * rounding <= forms::kEnergyError)) {
    std::ostringstream message;
    message << "rounding may change the periods of a pole at vertex " << vertex << " by " << inverse_ * rounding
            << ": triangles are too thin for double precision";
    throw SolverError(message.str());
  }
  return gram_.solve(P.transpose());
}

Eigen::VectorXd nearest_representative(const Eigen::VectorXd& value, const Eigen::VectorXd& near) {
  return value.array() + (near - value).array().round();
}

}  // namespace holomorph::tiling
