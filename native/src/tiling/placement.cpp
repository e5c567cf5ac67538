#include "tiling/placement.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>

#include "linear/dense.h"
#include "mesh/stars.h"
#include "tiling/poles/pole_placement.h"
#include "uv/balance.h"

namespace holomorph::tiling {
namespace {

constexpr int kNewtonSteps = 40;         // at most, in Newton's method
constexpr double kDone = 1e-8;           // rms |mu| that counts as 0
constexpr double kStride = 0.03;         // longest step, in square roots of the area: J changes with faces
constexpr double kShortestMove = 1e-9;   // shortest step, in the same unit
constexpr double kNewtonDamping = 1e-6;  // of J J^T, relative to its mean diagonal entry
constexpr double kExchangeGain = 1e-9;   // least relative fall of the squared defect in an exchange
constexpr std::size_t kExchangeRounds = 12, kPairs = 2400;  // at most, that exchange pairs; and pairs in all rounds
constexpr std::size_t kExchangeAround = 36;                 // vertices around a pole that it may be exchanged for

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
    for (int step = 0; step < kNewtonSteps && !free.empty(); ++step) {
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
      JJ.diagonal().array() += kNewtonDamping * JJ.trace() / static_cast<double>(2 * g);
      const VectorXd dz = -J.transpose() * linear::solve_symmetric(JJ, residual);
      double longest = 0;
      for (Index f = 0; f < dz.size(); f += 2) longest = std::max(longest, std::hypot(dz[f], dz[f + 1]));
      if (longest < kShortestMove * root) return;
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
    for (const int v : mesh::vertices_around(basis_.half_edges(), poles_.vertices[i], stays ? 0 : kExchangeAround)) {
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
    for (std::size_t round = 0; round < std::clamp<std::size_t>(kPairs / pairs, 1, kExchangeRounds); ++round) {
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
    double least = now.squaredNorm() * (1 - kExchangeGain);
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

// Transfers the form from the level to the surface: the same residues, and the c_j with which it fits best as a vector
// field in space. Then both are optimised on the surface.
// @param greens of the level; afterwards of the surface
MeromorphicForm transferred(MeromorphicForm form, GreensFunctions& greens, const CoarseLevel& level,
                            std::shared_ptr<const mesh::Surface> surface, uv::Coefficients kind,
                            const PoleOptions& options, const Placement* like, Execution& execution) {
  const VectorXcd wanted = samples_of(form, greens);
  const MatrixXcd frames = uv::tangent_frames(*level.surface, greens.basis().samples());
  for (int& v : form.poles) v = level.vertex[v];
  const bool is_whole = level.is_whole(*surface);
  std::shared_ptr<const PoleBasis> own;
  if (like)
    own = like->basis;
  else if (is_whole)
    own = std::make_shared<const PoleBasis>(std::move(surface), options.solving, execution);
  else
    own =
        std::make_shared<const PoleBasis>(std::move(surface), options.solving, greens.shared_basis(), level, execution);
  greens = is_whole ? GreensFunctions(std::move(own)) : std::move(greens).on(std::move(own));
  const PoleBasis& basis = greens.basis();
  greens.solve_at(form.poles, execution);
  if (basis.form_count() > 0) {
    form.coefficients =
        fitted_coefficients(wanted, frames, basis.holomorphic().M, greens.at(form.poles) * form.residues,
                            uv::tangent_frames(basis.surface(), basis.samples()), kind == uv::Coefficients::real);
  }
  return optimised(greens, kind, std::move(form), execution);
}

// Makes the placement. It keeps the Green's functions of the poles alone, and drops those of the search.
Placement placement(PoleOptions options, uv::Coefficients kind, const GreensFunctions& greens, MeromorphicForm form,
                    PlacementStart start, const Placement* like, Execution& execution) {
  const auto& basis = greens.shared_basis();
  const double ratio = density_ratio(density(form, greens));
  Placement result{std::move(options), basis, kind, GreensFunctions(basis), std::move(form), ratio, std::move(start)};
  if (basis->has_jacobian())
    result.inversion = like ? like->inversion : std::make_shared<const JacobiInversion>(*basis, execution);
  result.greens.solve_at(result.form.poles, execution);
  return result;
}

PlacementStart started(const std::shared_ptr<const mesh::Surface>& surface, const PoleOptions& options, int triangles,
                       Execution& execution) {
  execution.stage("level for the poles", 0.0, 0.2);
  CoarseLevel level{surface, {}, {}};
  if (!options.is_chosen()) {
    const auto levels = options.levels ? options.levels : std::make_shared<const Levels>(surface, execution);
    level = levels->level(triangles, execution);
  }
  execution.stage("forms for the poles", 0.2, 0.25);
  auto basis = std::make_shared<const PoleBasis>(level.surface, options.solving, execution);
  return {std::move(level), std::move(basis), std::make_shared<BalancedForm>()};
}

uv::Coefficients kind_of(const mesh::Surface& surface, const PoleOptions& options) {
  const auto type = mesh::topological_type(surface);
  return !type.closed() && (options.straight || type.genus > 0) ? uv::Coefficients::real : uv::Coefficients::complex;
}

// Whether another placement begins with the same.
bool is_alike(const Placement& other, const mesh::Surface& surface, const PoleOptions& options, uv::Coefficients kind) {
  return other.basis->structure().surface.get() == &surface && other.kind == kind &&
         other.options.solving.solver == options.solving.solver && !other.options.is_chosen() && !options.is_chosen();
}

}  // namespace

MatrixXcd JacobiInversion::reach(const std::vector<int>& vertices, const VectorXcd& residues) const {
  const MatrixXcd effect = jacobian.tau(jacobian.triangles_at(vertices)) * residues.asDiagonal();
  return effect * effect.adjoint();
}

LiftedPoles JacobiInversion::moved(LiftedPoles poles, const VectorXcd& periods, const VectorXcd& residues,
                                   const MatrixXcd& metric, const MoveOptions& options) const {
  return Moving(*this, periods, residues, metric, options, std::move(poles)).run();
}

Placement place(std::shared_ptr<const mesh::Surface> surface, PoleOptions options, Execution& execution,
                const Placement* like) {
  const uv::Coefficients kind = kind_of(*surface, options);
  if (like && !is_alike(*like, *surface, options, kind)) like = nullptr;
  PlacementStart start = like ? like->start : started(surface, options, kLevelTriangles, execution);
  const CoarseLevel& level = start.level;
  GreensFunctions greens(start.basis);
  PlaceOptions place_options{kind, {}, options.vertices, level.large_polygons, options.evened, start.balanced};
  // Where poles are allowed, in the numbers of the level.
  for (const int v : level.vertex) {
    if (!options.allowed.empty()) place_options.allowed.push_back(options.allowed[v]);
  }
  execution.stage("search for poles", 0.25, 0.6);
  MeromorphicForm form = options.count ? placed_poles(greens, place_options, *options.count, execution)
                                       : placed_poles(greens, place_options, execution);
  execution.stage("forms of the surface", 0.6, 1.0);
  if (level.surface != surface)
    form = transferred(std::move(form), greens, level, surface, kind, options, like, execution);
  Placement result = placement(std::move(options), kind, greens, std::move(form), std::move(start), like, execution);
  execution.finish();
  return result;
}

double ratio_without_poles(const std::shared_ptr<const mesh::Surface>& surface, const PoleOptions& options,
                           Execution& execution) {
  const Execution::Within within(execution);
  const PlacementStart start = started(surface, options, kFewTriangles, execution);
  GreensFunctions greens(start.basis);
  const PlaceOptions asked{
      kind_of(*surface, options), {}, {}, start.level.large_polygons, options.evened, start.balanced};
  return density_ratio(density(placed_poles(greens, asked, 0, execution), greens));
}

std::shared_ptr<const SeamlessMaps> maps_at(const Placement& placement, const std::vector<int>& poles,
                                            Execution& execution) {
  return placement.maps->get(poles, [&] {
    const Execution::Within within(execution);
    return std::make_shared<SeamlessMaps>(placement.basis, placement.kind == uv::Coefficients::real, poles,
                                          placement.options.labels, placement.options.solving, execution);
  });
}

LiftedPoles lifted_poles(const Placement& placement, Execution& execution) {
  LiftedPoles lifted{placement.form.poles, std::vector<VectorXd>(placement.form.poles.size())};
  if (placement.inversion) {
    for (std::size_t i = 0; i < lifted.parts.size(); ++i)
      lifted.parts[i] = placement.inversion->abel_jacobi.at(lifted.vertices[i]);
  } else if (!lifted.parts.empty()) {
    const auto maps = maps_at(placement, lifted.vertices, execution);
    const MatrixXd& parts = maps->pole_parts();
    for (Index i = 0; i < parts.cols(); ++i) lifted.parts[i] = parts.col(i);
  }
  return lifted;
}

}  // namespace holomorph::tiling
