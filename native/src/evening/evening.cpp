#include "evening/evening.h"

#include <memory>
#include <utility>

#include "base/chunks.h"
#include "evening/descent.h"
#include "evening/strain_energy.h"
#include "forms/laplacian.h"
#include "mesh/half_edges.h"
#include "solver/solver_choice.h"

namespace holomorph::evening {
namespace {

constexpr int kMostSteps = 60;
constexpr double kProgress = 3e-3;  // it ends where a step lowers the energy by less than this part of it
constexpr double kFar = 0.03;       // where it lowers it by more, the Laplacian is made anew
constexpr double kDecrease = 1e-4;  // Armijo's
constexpr double kShortest = 1e-6;  // step, of the direction

// The weight of size in the energy. Where strain is small, minimising takes the power 1 - lambda of every density, and
// s1 / s2 grows by lambda times the logarithm of the density over its mean.
double lambda_of(double evenness) { return evenness * (0.9 - 0.2 * evenness); }

class Evening {
 public:
  Evening(const mesh::Surface& surface, const uv::UvArray& uv, const Kept& kept, double evenness,
          const std::string& solver, Execution& execution)
      : energy_(surface, uv, kept.poles, execution.workers()),
        half_edges_(mesh::half_edges(surface, execution)),
        kept_(kept),
        lambda_(lambda_of(evenness)),
        method_(solver::choose_method(solver, surface.vertex_count, 2).method),
        execution_(execution),
        workers_(execution.workers()) {}

  Function run() {
    const auto count = static_cast<std::size_t>(half_edges_.n_vertices());
    Function delta(count, 0.0), kept = delta, gradient;
    StrainEnergy::Value value = at(delta, gradient);
    const double most_flipped = value.flipped;
    bool is_far = true;
    for (int step = 0; step < kMostSteps; ++step) {
      execution_.part(static_cast<double>(step) / kMostSteps, static_cast<double>(step + 1) / kMostSteps);
      execution_.report(0);
      if (is_far) begin_at(delta);
      const double before = value.energy;
      descend(delta, gradient, value);
      if (value.flipped <= most_flipped) kept = delta;
      const double progress = (before - value.energy) / before;
      is_far = progress > kFar;
      if (progress >= kProgress) continue;
      if (value.flipped <= most_flipped) break;
      energy_.emphasise_flipped(delta, workers_);
      value = at(delta, gradient);
      is_far = true;
    }
    return kept;
  }

 private:
  StrainEnergy::Value at(const Function& delta, Function& gradient) {
    const StrainEnergy::Value value = energy_(delta, lambda_, gradient, at_corners_, workers_);
    clear_kept(gradient);
    return value;
  }

  void clear_kept(Function& function) const {
    for (const int v : kept_.u) function[v].real(0);
    for (const int v : kept_.v) function[v].imag(0);
  }

  void begin_at(const Function& delta) {
    descent_ = Descent();
    solver_.reset();  // its memory goes first
    solver_ = solver::make_solver(method_, forms::laplacian(half_edges_, energy_.weights(delta, lambda_), execution_),
                                  kept_.u.empty() ? kept_.v : kept_.u, execution_);
  }

  // One step, after which the energy is less, or the same where there is no way down.
  void descend(Function& delta, Function& gradient, StrainEnergy::Value& value) {
    Function direction = descent_.direction(
        gradient, [this](const Function& g) { return preconditioned(g); }, workers_);
    clear_kept(direction);
    const double slope = Descent::product(gradient, direction, workers_);
    if (!(slope < 0)) return;
    Function next, next_gradient;
    StrainEnergy::Value next_value;
    double length = 1;
    for (;; length /= 2) {
      if (!(length > kShortest)) return;
      next = delta;
      Descent::add(next, length, direction, workers_);
      next_value = at(next, next_gradient);
      if (next_value.energy <= value.energy + kDecrease * length * slope) break;
    }
    for_rows(workers_, static_cast<int>(direction.size()), [&](int v) {
      direction[v] *= length;
      gradient[v] = next_gradient[v] - gradient[v];
    });
    descent_.take(std::move(direction), std::move(gradient), workers_);
    delta = std::move(next);
    gradient = std::move(next_gradient);
    value = next_value;
  }

  Function preconditioned(const Function& gradient) {
    const auto count = static_cast<int>(gradient.size());
    Eigen::MatrixXd B(count, 2);
    for_rows(workers_, count, [&](int v) { B.row(v) << gradient[v].real(), gradient[v].imag(); });
    const auto condition = [](const std::vector<int>& kept) {
      return kept.empty() ? solver::Condition::natural : solver::Condition::dirichlet;
    };
    const auto X = solver_->precondition(B, {condition(kept_.u), condition(kept_.v)}, execution_);
    Function result(count);
    // The second derivatives are about twice the Laplacian.
    for_rows(workers_, count, [&](int v) { result[v] = 0.5 * Complex(X(v, 0), X(v, 1)); });
    return result;
  }

  StrainEnergy energy_;
  const mesh::HalfEdges half_edges_;
  const Kept& kept_;
  const double lambda_;
  const solver::Method method_;
  Execution& execution_;
  Workers& workers_;
  std::unique_ptr<solver::LaplaceSolver> solver_;
  Descent descent_;
  Function at_corners_;
};

}  // namespace

double power_of_density(double evenness) { return 1 - lambda_of(evenness); }

uv::UvArray evened(const mesh::Surface& surface, const uv::UvArray& uv, const Kept& kept, double evenness,
                   Execution& execution, const std::string& solver) {
  uv::UvArray result = uv::UvArray::Zero(surface.vertex_count, 2);
  if (evenness == 0) return result;
  const Function delta = Evening(surface, uv, kept, evenness, solver, execution).run();
  for_rows(execution.workers(), surface.vertex_count,
           [&](int v) { result.row(v) << delta[v].real(), delta[v].imag(); });
  return result;
}

}  // namespace holomorph::evening
