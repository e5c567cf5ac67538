#include "evening/evening.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "base/chunks.h"
#include "evening/descent.h"
#include "evening/patch.h"
#include "evening/turned_solver.h"
#include "forms/laplacian.h"
#include "mesh/half_edges.h"
#include "solver/solver_choice.h"

namespace holomorph::evening {
namespace {

constexpr int kMostSteps = 40;
constexpr double kWhole = 0.9;  // part of the work before flipped triangles are turned back, for the progress function
// Rings of triangles around flipped ones, tried in turn: all of them may move, and the inner ones keep the shape that
// the map before evening gives them. Keeping it costs evenness, so moving alone is tried first.
constexpr StrainEnergy::Rings kRings[] = {{2, 0}, {4, 0}, {8, 0}, {16, 0}, {4, 2}, {8, 4}, {16, 8}, {32, 16}};
// The next rings are tried if the last ones left at most this part of the flipped area: where some do not help, larger
// ones rarely do.
constexpr double kHelps = 0.9;
// Factors of the weight of size, one after the other where the map flips more than before. A little less size is often
// enough, since few triangles decide; where more than this part of the area is flipped, at most half is tried next.
constexpr double kFactors[] = {1, 0.93, 0.86, 0.75, 0.5, 0.25, 0.125, 0.0625};
constexpr double kMuch = 1e-4;
// Where this part of the area is flipped beyond what was, the whole map is wrong, and half the weight is tried.
constexpr double kTooMuch = 0.05;
// All surroundings together may take as much work as this number of steps on the whole surface. A small mesh counts as
// one of kFewVertices: it costs little, and its surroundings soon are all of it.
constexpr double kMostTurning = 100;
constexpr int kFewVertices = 5000;

// The weight of size in the energy. Where strain is small and size counts by its square, minimising takes the power
// 1 - lambda of every density, and s1 / s2 grows by lambda times the logarithm of the density over its mean.
double lambda_of(double evenness) { return evenness * (0.78 - 0.08 * evenness); }

solver::Condition condition(const std::vector<int>& kept) {
  return kept.empty() ? solver::Condition::natural : solver::Condition::dirichlet;
}

// The solvers for u and for v. One serves both if there is one set of fixed vertices: it knows the natural condition as
// well.
class Solvers {
 public:
  Solvers(const mesh::Surface& surface, const Kept& kept, const std::string& solver, Execution& execution)
      : half_edges_(mesh::half_edges(surface, execution)),
        method_(solver::choose_method(solver, surface.vertex_count, 2).method),
        kept_(kept) {}

  void make(const Array<double>& edge_weights, Execution& execution) {
    u_.reset(), v_.reset();  // first, so that their memory is free for the new ones
    const bool same = kept_.u.empty() || kept_.v.empty() || kept_.u == kept_.v;
    u_ = made(edge_weights, kept_.u.empty() ? kept_.v : kept_.u, execution);
    v_ = same ? u_ : made(edge_weights, kept_.v, execution);
  }

  Function precondition(const Function& gradient, Execution& execution) const {
    const auto count = static_cast<int>(gradient.size());
    Eigen::MatrixXd B(count, 2);
    for_rows(execution.workers(), count, [&](int v) { B.row(v) << gradient[v].real(), gradient[v].imag(); });
    const solver::Condition on_u = condition(kept_.u), on_v = condition(kept_.v);
    solver::Solution X(count, 2);
    if (u_ == v_)
      X = u_->precondition(B, {on_u, on_v}, execution);
    else
      X << u_->precondition(B.col(0), {on_u}, execution), v_->precondition(B.col(1), {on_v}, execution);
    Function result(count);
    for_rows(execution.workers(), count, [&](int v) { result[v] = kInverse * Complex(X(v, 0), X(v, 1)); });
    return result;
  }

 private:
  std::shared_ptr<solver::LaplaceSolver> made(const Array<double>& edge_weights, const std::vector<int>& fixed,
                                              Execution& execution) const {
    return solver::make_solver(method_, forms::laplacian(half_edges_, edge_weights, execution), fixed, execution);
  }

  const mesh::HalfEdges half_edges_;
  const solver::Method method_;
  const Kept& kept_;
  std::shared_ptr<solver::LaplaceSolver> u_, v_;
};

void clear(Function& function, const Kept& kept) {
  for (const int v : kept.u) function[v].real(0);
  for (const int v : kept.v) function[v].imag(0);
}

struct Found {
  Function delta;
  double flipped_more;  // than in the map before, a part of the area
};

Found least(const mesh::Surface& surface, const StrainEnergy& energy, const Kept& kept, double lambda,
            const std::string& solver_name, double& vertex_steps, Execution& execution) {
  std::optional<Solvers> shifted;
  std::optional<TurnedSolver> turned;
  if (kept.turns.empty())
    shifted.emplace(surface, kept, solver_name, execution);
  else
    turned.emplace(surface, kept, solver_name);
  const auto make = [&](const Function& delta) -> Precondition {
    const Array<double> weights = energy.edge_weights(surface, delta, lambda);
    const auto with = [&](auto& solver) -> Precondition {
      solver.make(weights, execution);
      return [&execution, made = &solver](const Function& gradient) { return made->precondition(gradient, execution); };
    };
    return shifted ? with(*shifted) : with(*turned);
  };
  Descent descent(
      energy, lambda, make, [&](Function& f) { clear(f, kept); }, execution.workers());
  const double flipped_before = descent.begin(Function(surface.vertex_count, 0.0)).flipped;
  // Whole numbers flip triangles at the cones of a map that turns: these are turned back as well.
  const double most_flipped = kept.turns.empty() ? flipped_before : 0;
  for (int step = 0; step < kMostSteps; ++step) {
    execution.part(kWhole * step / kMostSteps, kWhole * (step + 1) / kMostSteps);
    execution.report(0);
    if (!descent.step()) break;
  }
  execution.part(kWhole, 1);
  Function delta = descent.delta();
  double beyond = descent.value().flipped - most_flipped;
  // Ever larger surroundings, each from what the last one has reached.
  for (const StrainEnergy::Rings rings : kRings) {
    if (beyond <= 0 || beyond > kTooMuch || !(vertex_steps > 0)) break;
    const double before = beyond;
    beyond = turn_back(energy, kept, lambda, rings, delta, vertex_steps, execution);
    if (beyond > kHelps * before) break;
  }
  return {std::move(delta), beyond - (flipped_before - most_flipped)};
}

}  // namespace

uv::UvArray evened(const mesh::Surface& surface, uv::UvArray uv, const Kept& kept, double evenness,
                   Execution& execution, const std::string& solver) {
  if (evenness == 0) return uv::UvArray::Zero(surface.vertex_count, 2);
  const StrainEnergy energy(surface, uv, kept.poles, kept.turns, execution.workers());
  uv.resize(0, 2);  // the energy knows it, and its memory is free for the descent
  // The first weight of size with which no more area is flipped than before. If there is none, the map stays as it is.
  double most = 1, vertex_steps = kMostTurning * std::max(surface.vertex_count, kFewVertices);
  for (const double factor : kFactors) {
    if (factor > most) continue;
    const Found found = least(surface, energy, kept, factor * lambda_of(evenness), solver, vertex_steps, execution);
    if (found.flipped_more > kMuch) most = factor / 2;
    if (found.flipped_more > 0) continue;
    uv::UvArray result(surface.vertex_count, 2);
    for_rows(execution.workers(), surface.vertex_count,
             [&](int v) { result.row(v) << found.delta[v].real(), found.delta[v].imag(); });
    return result;
  }
  return uv::UvArray::Zero(surface.vertex_count, 2);
}

double strain(const mesh::Surface& surface, const uv::UvArray& uv, const Kept& kept, double evenness,
              Execution& execution) {
  const StrainEnergy energy(surface, uv, kept.poles, kept.turns, execution.workers());
  Function gradient, at_corners;
  return energy(Function(surface.vertex_count, 0.0), lambda_of(evenness), gradient, at_corners, execution.workers())
      .energy;
}

}  // namespace holomorph::evening
