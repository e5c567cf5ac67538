#include "tiling/pole_moves.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>

#include "mesh/surface_walk.h"
#include "tiling/pole_vertices.h"

namespace holomorph::tiling {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

constexpr int kSteps = 40;           // at most, in Newton's method
constexpr double kDone = 1e-8;       // rms |mu| that is nothing
constexpr double kStride = 0.03;     // longest step, in square roots of the area
constexpr double kDamping = 1e-6;    // relative
constexpr int kRounds = 12;          // at most, that exchange pairs
constexpr std::size_t kAround = 36;  // vertices around a pole that are exchanged

// The poles while they move. One that has gone to a vertex is held there.
class Moving {
 public:
  Moving(const Landscape& landscape, const AbelJacobi& abel_jacobi, const Leverage& leverage, const VectorXcd& periods,
         const VectorXcd& residues, const MatrixXcd& metric, const MoveRules& rules, PlacedPoles poles)
      : landscape_(landscape),
        leverage_(leverage),
        periods_(periods),
        residues_(residues),
        to_defect_(metric * leverage.split().bottomRows(metric.cols())),
        metric_(metric),
        rules_(rules),
        vertices_(landscape, abel_jacobi, rules.allowed),
        poles_(std::move(poles)),
        held_(rules.held.empty() ? std::vector<char>(poles_.vertices.size(), 0) : rules.held),
        gone_(poles_.vertices.size(), 0.0) {
    const std::vector<int> triangles = leverage.triangles_at(poles_.vertices);
    for (std::size_t i = 0; i < triangles.size(); ++i)
      points_.push_back(mesh::at_vertex(landscape.surface(), triangles[i], poles_.vertices[i]));
  }

  PlacedPoles run() {
    newton();
    for (const std::size_t i : by_leverage()) {
      if (held_[i]) continue;
      hold(i);
      newton();
    }
    exchange_pairs();
    return std::move(poles_);
  }

 private:
  VectorXcd defect() const {
    VectorXcd X = periods_;
    for (std::size_t i = 0; i < poles_.parts.size(); ++i) X += residues_[static_cast<Index>(i)] * poles_.parts[i];
    return to_defect_ * X;
  }

  // What a triangle has to do with the poles on it, found once.
  struct OnTriangle {
    VectorXcd derivative;  // the Abel-Jacobi map, differentiated
    VectorXcd tau;
  };

  const OnTriangle& on_triangle(int triangle) {
    OnTriangle& found = on_triangle_[triangle];
    if (found.tau.size() == 0)
      found = {leverage_.abel_jacobi_derivatives({triangle}), metric_ * leverage_.tau({triangle})};
    return found;
  }

  VectorXcd lever(std::size_t i) { return on_triangle(points_[i].triangle).tau * residues_[static_cast<Index>(i)]; }

  std::vector<std::size_t> by_leverage() {
    std::vector<std::size_t> order(poles_.vertices.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::vector<double> size;
    for (const std::size_t i : order) size.push_back(lever(i).norm());
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return size[a] > size[b]; });
    return order;
  }

  // Steps of least length, minimal |J dz + defect|.
  void newton() {
    const double root = std::sqrt(landscape_.area());
    std::vector<std::size_t> free;
    for (std::size_t i = 0; i < held_.size(); ++i) {
      if (!held_[i]) free.push_back(i);
    }
    if (free.empty()) return;
    for (int step = 0; step < kSteps; ++step) {
      const VectorXcd e = defect();
      if (e.norm() < kDone) return;
      const Index g = e.size();
      MatrixXd J(2 * g, 2 * static_cast<Index>(free.size()));
      for (std::size_t f = 0; f < free.size(); ++f) {
        const VectorXcd l = lever(free[f]);  // changes by l dz
        const auto column = 2 * static_cast<Index>(f);
        J.col(column) << l.real(), l.imag();
        J.col(column + 1) << -l.imag(), l.real();
      }
      VectorXd residual(2 * g);
      residual << e.real(), e.imag();
      MatrixXd JJ = J * J.transpose();
      JJ.diagonal().array() += kDamping * JJ.trace() / static_cast<double>(2 * g);
      const VectorXd dz = -J.transpose() * JJ.ldlt().solve(residual);
      double longest = 0;
      for (Index f = 0; f < dz.size(); f += 2) longest = std::max(longest, std::hypot(dz[f], dz[f + 1]));
      if (longest < 1e-9 * root) return;
      const double shrink = std::min(1.0, kStride * root / longest);
      for (std::size_t f = 0; f < free.size(); ++f)
        move(free[f], shrink * Complex(dz[2 * static_cast<Index>(f)], dz[2 * static_cast<Index>(f) + 1]));
    }
  }

  void move(std::size_t i, Complex dz) {
    const double left = rules_.most * std::sqrt(landscape_.area()) - gone_[i];
    if (!(left > 0)) return;
    if (std::abs(dz) > left) dz *= left / std::abs(dz);
    gone_[i] += std::abs(dz);
    for (const auto& [triangle, part] :
         mesh::walk(landscape_.surface(), landscape_.half_edges(), landscape_.sides(), points_[i], dz))
      poles_.parts[i] -= (on_triangle(triangle).derivative * part).real();
  }

  // The corners around the settled poles but two, ascending.
  std::vector<int> corners_but(std::size_t i, std::size_t j) const {
    std::vector<int> all;
    for (std::size_t k = 0; k < poles_.vertices.size(); ++k) {
      if (k == i || k == j || !held_[k]) continue;
      const auto corners = vertices_.corners_around(poles_.vertices[k]);
      all.insert(all.end(), corners.begin(), corners.end());
    }
    std::sort(all.begin(), all.end());
    return all;
  }

  // At the nearest vertex that can take it, else back where it was.
  void hold(std::size_t i) {
    const std::vector<int> others = corners_but(i, i);
    for (const int v : mesh::nearest_corners(landscape_.surface(), points_[i])) {
      if (!vertices_.is_allowed(v) || !are_apart(vertices_.corners_around(v), others)) continue;
      poles_.vertices[i] = v;
      break;
    }
    poles_.parts[i] = vertices_.part(poles_.vertices[i], poles_.parts[i]);
    held_[i] = 1;
  }

  struct Neighbour {
    int vertex;
    std::vector<int> corners;
    VectorXd part;
    VectorXcd effect;  // on the defect, with the residue
  };

  // The vertices around a pole, itself among them; it alone where the pole has to stay.
  std::vector<Neighbour> around(std::size_t i) {
    std::vector<Neighbour> list;
    for (const int v : vertices_.around(poles_.vertices[i], !rules_.held.empty() && rules_.held[i] ? 0 : kAround)) {
      VectorXd part = vertices_.part(v, poles_.parts[i]);
      VectorXcd effect = residues_[static_cast<Index>(i)] * (to_defect_ * part.cast<Complex>());
      list.push_back({v, vertices_.corners_around(v), std::move(part), std::move(effect)});
    }
    return list;
  }

  void exchange_pairs() {
    std::vector<std::vector<Neighbour>> near(held_.size());
    for (int round = 0; round < kRounds; ++round) {
      for (std::size_t i = 0; i < near.size(); ++i) {
        if (near[i].empty() || near[i].front().vertex != poles_.vertices[i]) near[i] = around(i);
      }
      bool better = false;
      for (std::size_t i = 0; i < near.size(); ++i) {
        for (std::size_t j = i + 1; j < near.size(); ++j) better |= exchange(i, j, near);
      }
      if (!better) return;
    }
  }

  bool exchange(std::size_t i, std::size_t j, const std::vector<std::vector<Neighbour>>& near) {
    const VectorXcd now = defect();
    const auto effect = [&](std::size_t k) -> VectorXcd {
      return residues_[static_cast<Index>(k)] * (to_defect_ * poles_.parts[k].cast<Complex>());
    };
    const VectorXcd rest = now - effect(i) - effect(j);
    const std::vector<int> others = corners_but(i, j);
    double least = now.squaredNorm() * (1 - 1e-9);
    const Neighbour *first = nullptr, *second = nullptr;
    for (const Neighbour& a : near[i]) {
      if (!are_apart(a.corners, others)) continue;
      const VectorXcd with = rest + a.effect;
      for (const Neighbour& b : near[j]) {
        const double size = (with + b.effect).squaredNorm();
        if (size < least && are_apart(b.corners, others) && are_apart(a.corners, b.corners)) {
          least = size;
          first = &a;
          second = &b;
        }
      }
    }
    if (!first) return false;
    poles_.vertices[i] = first->vertex;
    poles_.parts[i] = first->part;
    poles_.vertices[j] = second->vertex;
    poles_.parts[j] = second->part;
    return true;
  }

  const Landscape& landscape_;
  const Leverage& leverage_;
  const VectorXcd& periods_;
  const VectorXcd& residues_;
  MatrixXcd to_defect_;  // g x 2g
  const MatrixXcd& metric_;
  const MoveRules& rules_;
  PoleVertices vertices_;
  PlacedPoles poles_;
  std::vector<mesh::SurfacePoint> points_;
  std::vector<char> held_;
  std::vector<double> gone_;
  std::unordered_map<int, OnTriangle> on_triangle_;
};

}  // namespace

PoleMoves::PoleMoves(const Landscape& landscape, const AbelJacobi& abel_jacobi)
    : landscape_(landscape), abel_jacobi_(abel_jacobi), leverage_(landscape) {}

MatrixXcd PoleMoves::reach(const std::vector<int>& vertices, const VectorXcd& residues) const {
  const MatrixXcd lever = leverage_.tau(leverage_.triangles_at(vertices)) * residues.asDiagonal();
  return lever * lever.adjoint();
}

PlacedPoles PoleMoves::moved(PlacedPoles poles, const VectorXcd& periods, const VectorXcd& residues,
                             const MatrixXcd& metric, const MoveRules& rules) const {
  return Moving(landscape_, abel_jacobi_, leverage_, periods, residues, metric, rules, std::move(poles)).run();
}

}  // namespace holomorph::tiling
