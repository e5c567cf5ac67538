#include "tiling/inversion/jacobi_inversion.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>

#include "linear/dense.h"
#include "mesh/stars.h"
#include "mesh/surface_walk.h"

namespace holomorph::tiling {
namespace {

constexpr int kSteps = 40;                          // at most, in Newton's method
constexpr double kDone = 1e-8;                      // rms |mu| that counts as 0
constexpr double kStride = 0.03;                    // longest step, in square roots of the area: J changes with faces
constexpr double kShortest = 1e-9;                  // shortest step, in the same unit
constexpr double kDamping = 1e-6;                   // of J J^T, relative to its mean diagonal entry
constexpr double kGain = 1e-9;                      // least relative fall of the squared defect in an exchange
constexpr std::size_t kRounds = 12, kPairs = 2400;  // at most, that exchange pairs; and pairs in all rounds
constexpr std::size_t kAround = 36;                 // vertices around a pole that it may be exchanged for

// The poles while they move over the faces. `held_` marks those that are fixed at a vertex.
class Moving {
 public:
  Moving(const JacobiInversion& inversion, const VectorXcd& periods, const VectorXcd& residues, const MatrixXcd& metric,
         const MoveOptions& options, LiftedPoles poles)
      : inversion_(inversion),
        basis_(inversion.basis),
        periods_(periods),
        residues_(residues),
        to_defect_(metric * inversion.jacobian.split().bottomRows(metric.cols())),
        metric_(metric),
        options_(options),
        poles_(std::move(poles)),
        held_(options.held.empty() ? std::vector<char>(poles_.vertices.size(), 0) : options.held),
        gone_(poles_.vertices.size(), 0.0) {
    const std::vector<int> triangles = inversion.jacobian.triangles_at(poles_.vertices);
    for (std::size_t i = 0; i < triangles.size(); ++i)
      points_.push_back(mesh::at_vertex(basis_.surface(), triangles[i], poles_.vertices[i]));
  }

  LiftedPoles run() {
    newton();
    for (const std::size_t i : by_effect()) {  // the largest first: those left can still cancel the error
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

  // The part of a pole in the defect if its harmonic part is `part`.
  VectorXcd effect_of(std::size_t i, const VectorXd& part) const {
    return residues_[static_cast<Index>(i)] * (to_defect_ * part.cast<Complex>());
  }

  // What the poles on a triangle have in common, found once.
  struct OnTriangle {
    VectorXcd derivative;  // the Abel-Jacobi map, differentiated
    VectorXcd tau;
  };

  const OnTriangle& on_triangle(int triangle) {
    OnTriangle& found = on_triangle_[triangle];
    if (found.tau.size() == 0)
      found = {inversion_.jacobian.abel_jacobi_derivatives({triangle}), metric_ * inversion_.jacobian.tau({triangle})};
    return found;
  }

  // The change of the defect by dz, over dz.
  VectorXcd effect_of_step(std::size_t i) {
    return on_triangle(points_[i].triangle).tau * residues_[static_cast<Index>(i)];
  }

  std::vector<std::size_t> by_effect() {
    std::vector<std::size_t> order(poles_.vertices.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::vector<double> size;
    for (const std::size_t i : order) size.push_back(effect_of_step(i).norm());
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return size[a] > size[b]; });
    return order;
  }

  // Damped Newton steps: of all dz with minimal |J dz + defect|, the shortest one.
  void newton() {
    const double root = std::sqrt(basis_.area());
    std::vector<std::size_t> free;
    for (std::size_t i = 0; i < held_.size(); ++i) {
      if (!held_[i]) free.push_back(i);
    }
    for (int step = 0; step < kSteps && !free.empty(); ++step) {
      options_.tick();
      const VectorXcd e = defect();
      if (e.norm() < kDone) return;
      const Index g = e.size();
      MatrixXd J(2 * g, 2 * static_cast<Index>(free.size()));
      for (std::size_t f = 0; f < free.size(); ++f) {
        const VectorXcd l = effect_of_step(free[f]);
        const auto column = 2 * static_cast<Index>(f);
        J.col(column) << l.real(), l.imag();  // the change is l dz, so i l for dz = i
        J.col(column + 1) << -l.imag(), l.real();
      }
      VectorXd residual(2 * g);
      residual << e.real(), e.imag();
      MatrixXd JJ = J * J.transpose();
      JJ.diagonal().array() += kDamping * JJ.trace() / static_cast<double>(2 * g);
      const VectorXd dz = -J.transpose() * linear::solve_symmetric(JJ, residual);
      double longest = 0;
      for (Index f = 0; f < dz.size(); f += 2) longest = std::max(longest, std::hypot(dz[f], dz[f + 1]));
      if (longest < kShortest * root) return;
      const double shrink = std::min(1.0, kStride * root / longest);
      for (std::size_t f = 0; f < free.size(); ++f)
        move(free[f], shrink * Complex(dz[2 * static_cast<Index>(f)], dz[2 * static_cast<Index>(f) + 1]));
    }
  }

  void move(std::size_t i, Complex dz) {
    const double left = options_.farthest * std::sqrt(basis_.area()) - gone_[i];
    if (!(left > 0)) return;
    if (std::abs(dz) > left) dz *= left / std::abs(dz);
    gone_[i] += std::abs(dz);
    const auto steps = mesh::walk(basis_.surface(), basis_.half_edges(), basis_.sides(), points_[i], dz);
    for (const auto& [triangle, part] : steps) poles_.parts[i] -= (on_triangle(triangle).derivative * part).real();
  }

  auto corners_around(int v) const { return mesh::corners_around(basis_.surface(), basis_.half_edges(), v); }

  // The corners around the settled poles but two, ascending.
  std::vector<int> corners_but(std::size_t i, std::size_t j) const {
    std::vector<int> all;
    for (std::size_t k = 0; k < poles_.vertices.size(); ++k) {
      if (k == i || k == j || !held_[k]) continue;
      const auto corners = corners_around(poles_.vertices[k]);
      all.insert(all.end(), corners.begin(), corners.end());
    }
    std::sort(all.begin(), all.end());
    return all;
  }

  // Places the pole at the nearest corner that can be one, or else back where it was. Its part is exact there.
  void hold(std::size_t i) {
    const std::vector<int> others = corners_but(i, i);
    for (const int v : mesh::nearest_corners(basis_.surface(), points_[i])) {
      if (!basis_.is_place(v, options_.allowed) || !mesh::are_apart(corners_around(v), others)) continue;
      poles_.vertices[i] = v;
      break;
    }
    poles_.parts[i] = nearest_representative(inversion_.abel_jacobi.at(poles_.vertices[i]), poles_.parts[i]);
    held_[i] = 1;
  }

  struct Neighbour {
    int vertex;
    std::vector<int> corners;
    VectorXd part;
    VectorXcd effect;
  };

  // The vertices around a pole, itself among them; it alone where the pole has to stay.
  std::vector<Neighbour> around(std::size_t i) {
    std::vector<Neighbour> list;
    const bool stays = !options_.held.empty() && options_.held[i];
    for (const int v : mesh::vertices_around(basis_.half_edges(), poles_.vertices[i], stays ? 0 : kAround)) {
      if (!basis_.is_place(v, options_.allowed)) continue;
      VectorXd part = nearest_representative(inversion_.abel_jacobi.at(v), poles_.parts[i]);
      const VectorXcd effect = effect_of(i, part);
      list.push_back({v, corners_around(v), std::move(part), effect});
    }
    return list;
  }

  void exchange_pairs() {  // two poles have many more values than one, some of which nearly cancel the defect
    std::vector<std::vector<Neighbour>> near(held_.size());
    const std::size_t pairs = near.size() * near.size() / 2 + 1;
    for (std::size_t round = 0; round < std::clamp<std::size_t>(kPairs / pairs, 1, kRounds); ++round) {
      for (std::size_t i = 0; i < near.size(); ++i) {
        if (near[i].empty() || near[i].front().vertex != poles_.vertices[i]) near[i] = around(i);
      }
      bool better = false;
      for (std::size_t i = 0; i < near.size(); ++i) {
        options_.tick();
        for (std::size_t j = i + 1; j < near.size(); ++j) better |= exchange(i, j, near);
      }
      if (!better) return;
    }
  }

  bool exchange(std::size_t i, std::size_t j, const std::vector<std::vector<Neighbour>>& near) {
    const VectorXcd now = defect();
    const VectorXcd rest = now - effect_of(i, poles_.parts[i]) - effect_of(j, poles_.parts[j]);
    const std::vector<int> others = corners_but(i, j);
    double least = now.squaredNorm() * (1 - kGain);
    const Neighbour *first = nullptr, *second = nullptr;
    for (const Neighbour& a : near[i]) {
      if (!mesh::are_apart(a.corners, others)) continue;
      const VectorXcd with = rest + a.effect;
      for (const Neighbour& b : near[j]) {
        const double size = (with + b.effect).squaredNorm();
        if (size < least && mesh::are_apart(b.corners, others) && mesh::are_apart(a.corners, b.corners)) {
          least = size;
          first = &a;
          second = &b;
        }
      }
    }
    if (!first) return false;
    for (const auto& [k, best] : {std::pair{i, first}, {j, second}}) {
      poles_.vertices[k] = best->vertex;
      poles_.parts[k] = best->part;
    }
    return true;
  }

  const JacobiInversion& inversion_;
  const PoleBasis& basis_;
  const VectorXcd& periods_;
  const VectorXcd& residues_;
  MatrixXcd to_defect_;  // g x 2g
  const MatrixXcd& metric_;
  const MoveOptions& options_;
  LiftedPoles poles_;
  std::vector<mesh::SurfacePoint> points_;
  std::vector<char> held_;
  std::vector<double> gone_;
  std::unordered_map<int, OnTriangle> on_triangle_;
};

}  // namespace

MatrixXcd JacobiInversion::reach(const std::vector<int>& vertices, const VectorXcd& residues) const {
  const MatrixXcd effect = jacobian.tau(jacobian.triangles_at(vertices)) * residues.asDiagonal();
  return effect * effect.adjoint();
}

LiftedPoles JacobiInversion::moved(LiftedPoles poles, const VectorXcd& periods, const VectorXcd& residues,
                                   const MatrixXcd& metric, const MoveOptions& options) const {
  return Moving(*this, periods, residues, metric, options, std::move(poles)).run();
}

}  // namespace holomorph::tiling
