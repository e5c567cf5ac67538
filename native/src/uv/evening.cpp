#include "uv/evening.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "base/workers.h"
#include "forms/laplacian.h"
#include "mesh/half_edges.h"
#include "mesh/union_find.h"
#include "solver/direct/sparse_cholesky.h"
#include "solver/solver_choice.h"
#include "uv/turned_functions.h"

namespace holomorph::uv {

// The energy of a connected part of the surface. Its map is the one with delta, so that its own function starts at 0.
struct StrainEnergy::Patch {
  StrainEnergy energy;
  std::vector<int> vertices;  // vertices of the surface: the free ones first
  int free_count = 0;         // how many of them are free to move
  double flipped_before = 0;  // the area that the map without delta flips
};

namespace {

// Turning back what evening flips: descents on small patches around it.

constexpr double kCollapsed = 1e-6;     // determinant of a map relative to its square: s1 / s2 is a million or more
constexpr int kSteps = 60, kUrges = 6;  // at most: steps before flipped triangles count more, and how often these do

bool any(const std::vector<char>& marked, const mesh::Triple& vertices) {
  return std::ranges::any_of(vertices, [&](int v) { return marked[v]; });
}

// The inverse of a Laplacian on the free vertices of a patch.
Precondition inverse(solver::SparseCholesky& factor, int free_count, bool turns) {
  return [&factor, free_count, turns](const Function& gradient) {
    Function result(gradient.size(), 0.0);
    if (turns) {
      Eigen::MatrixXd b(2 * free_count, 1);
      for (int v = 0; v < free_count; ++v) b(2 * v, 0) = gradient[v].real(), b(2 * v + 1, 0) = gradient[v].imag();
      const Eigen::MatrixXd x = factor.solve(b);
      for (int v = 0; v < free_count; ++v) result[v] = kInverse * Complex(x(2 * v, 0), x(2 * v + 1, 0));
      return result;
    }
    Eigen::MatrixXd B(free_count, 2);
    for (int v = 0; v < free_count; ++v) B.row(v) << gradient[v].real(), gradient[v].imag();
    const Eigen::MatrixXd X = factor.solve(B);
    for (int v = 0; v < free_count; ++v) result[v] = kInverse * Complex(X(v, 0), X(v, 1));
    return result;
  };
}

// The vertices at which u, or v, of a function on the surface does not move: #V each.
struct Fixed {
  std::vector<char> u, v;

  Fixed(const Kept& kept, std::size_t vertex_count) : u(vertex_count, 0), v(vertex_count, 0) {
    for (const int i : kept.u) u[i] = 1;
    for (const int i : kept.v) v[i] = 1;
    // What moves with vertices that may lie outside a patch stays.
    const std::vector<char> shared = kept.unknowns.shared();
    for (std::size_t p = 0; p < shared.size(); ++p) {
      if (shared[p]) (p % 2 == 0 ? u : v)[p / 2] = 1;
    }
  }
};

// Descends on a patch until no more than `most_flipped` is flipped. Where triangles are still flipped at the end, these
// count more, and the descent goes on from there. The best function on the way is kept, since a descent of the energy
// may flip more in between.
// @return the area that is then flipped; delta and vertex_steps as of the next function
double turn_back(StrainEnergy::Patch& patch, const Fixed& fixed, double lambda, double most_flipped, Function& delta,
                 double& vertex_steps, Execution& execution) {
  solver::SparseCholesky factor;
  const auto make = [&](const Function& at) -> Precondition {
    const Eigen::SparseMatrix<double> lower = patch.energy.laplacian(at, lambda, patch.free_count);
    factor.compute(lower, {});
    return inverse(factor, patch.free_count, lower.rows() > patch.free_count);
  };
  const auto clear = [&](Function& f) {
    for (int i = 0; i < std::ssize(f); ++i) {
      // The vertices beyond the free ones are the rim of the patch, which joins it to the rest.
      const bool is_rim = i >= patch.free_count;
      if (is_rim || fixed.u[patch.vertices[i]]) f[i].real(0);
      if (is_rim || fixed.v[patch.vertices[i]]) f[i].imag(0);
    }
  };
  Descent descent(patch.energy, lambda, make, clear, execution.workers());
  Function best(patch.vertices.size(), 0.0);
  double least_flipped = descent.begin(best).flipped;
  for (int urge = 0; urge < kUrges && least_flipped > most_flipped && vertex_steps > 0; ++urge) {
    for (int step = 0; step < kSteps && least_flipped > most_flipped && vertex_steps > 0 && descent.step(); ++step) {
      execution.report(0);
      vertex_steps -= static_cast<double>(patch.vertices.size());
      if (descent.value().flipped >= least_flipped) continue;
      least_flipped = descent.value().flipped;
      best = descent.delta();
    }
    patch.energy.emphasise_flipped(descent.delta(), execution.workers());
    descent.begin(Function(descent.delta()));
  }
  for (int i = 0; i < patch.free_count; ++i) delta[patch.vertices[i]] += best[i];
  return least_flipped;
}

// Turns triangles back that delta flips, patch by patch, until none has more flipped area than the map without delta;
// or none at all where functions turn: there whole numbers flip triangles, at cones. Only the patches move.
// @param delta on the whole surface; changed where that flips less
// @param vertex_steps steps left, each times the vertices of its patch
// @return the area that delta then flips beyond that
// @throws SolverError, Cancelled
double turn_back(const StrainEnergy& energy, const Kept& kept, double lambda, StrainEnergy::Rings rings,
                 Function& delta, double& vertex_steps, Execution& execution) {
  const Fixed fixed(kept, delta.size());
  double sum = 0;
  for (StrainEnergy::Patch& patch : energy.around_flipped(delta, rings)) {
    const double most = kept.turns.empty() ? patch.flipped_before : 0;
    sum += turn_back(patch, fixed, lambda, most, delta, vertex_steps, execution) - most;
  }
  return sum;
}

constexpr double kWhole = 0.9;  // part of the work before flipped triangles are turned back, for the progress function
// Rings of triangles around flipped ones, tried in turn: all of them may move, and the inner ones keep the shape that
// the map before evening gives them. Keeping it costs evenness, so moving alone is tried first.
constexpr StrainEnergy::Rings kRings[] = {{2, 0}, {4, 0}, {8, 0}, {16, 0}, {4, 2}, {8, 4}, {16, 8}, {32, 16}};
// The next rings are tried if the last ones left at most this part of the flipped area: where some do not help, larger
// ones rarely do.
constexpr double kHelps = 0.9;
// Rings of triangles around flipped ones, tried in turn, in which the function fades to the map before, where it flips
// no more than this part of the area.
constexpr int kFading[] = {2, 4, 8, 16, 32, 64};
constexpr double kMuch = 1e-4;
// Factors of the weight of size, one after the other where the map flips more than before.
constexpr double kFactors[] = {1, 0.5, 0.25, 0.125, 0.0625};
// Where this part of the area is flipped beyond what was, the whole map is wrong, and half the weight is tried.
constexpr double kTooMuch = 0.05;
// A small mesh counts as one of so many vertices when flipped triangles are turned back: it costs little, and their
// surroundings soon are all of it.
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

// Lessens delta around the triangles that it flips, by ever more rings, until no more area is flipped.
// @return the area that it then flips beyond `most_flipped`
double fade(const StrainEnergy& energy, double lambda, double most_flipped, Function& delta, Execution& execution) {
  const Function whole = delta;
  std::vector<char> flipped(delta.size(), 0);
  Function gradient, at_corners;
  double beyond = 0;
  for (const int rings : kFading) {
    execution.report(0);
    const std::vector<char> more = energy.flipped_corners(delta);
    for (std::size_t v = 0; v < more.size(); ++v) flipped[v] |= more[v];
    std::vector<char> inside = flipped;
    delta = whole;
    for (int ring = 0; ring < rings; ++ring, energy.grow(inside, 1)) {
      for (std::size_t v = 0; v < delta.size(); ++v) {
        if (inside[v]) delta[v] -= whole[v] / static_cast<double>(rings);
      }
    }
    beyond = energy(delta, lambda, gradient, at_corners, execution.workers()).flipped - most_flipped;
    if (beyond <= 0) break;
  }
  return beyond;
}

Found least(const mesh::Surface& surface, const StrainEnergy& energy, const Kept& kept, double lambda,
            const EveningOptions& options, double& vertex_steps, Execution& execution) {
  std::optional<Solvers> shifted;
  std::optional<TurnedSolver> turned;
  if (kept.turns.empty())
    shifted.emplace(surface, kept, options.solver, execution);
  else
    turned.emplace(surface, kept, options.solver == kDiagonal);
  const auto make = [&](const Function& delta) -> Precondition {
    const Array<double> weights = energy.edge_weights(surface, delta, lambda);
    if (turned) {
      turned->make(weights);
      return [&turned](const Function& gradient) { return turned->precondition(gradient); };
    }
    shifted->make(weights, execution);
    return [&](const Function& gradient) { return shifted->precondition(gradient, execution); };
  };
  Descent descent(
      energy, lambda, make, [&](Function& f) { clear(f, kept); }, execution.workers());
  const double flipped_before = descent.begin(Function(surface.vertex_count, 0.0)).flipped;
  // Whole numbers flip triangles at the cones of a map that turns: these are turned back as well.
  const double most_flipped = kept.turns.empty() ? flipped_before : 0;
  for (int step = 0; step < options.steps; ++step) {
    execution.part(kWhole * step / options.steps, kWhole * (step + 1) / options.steps);
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
  double more = beyond - (flipped_before - most_flipped);
  if (options.turning > 0 && more > 0 && more <= kMuch) more = fade(energy, lambda, flipped_before, delta, execution);
  return {std::move(delta), more};
}

}  // namespace

std::vector<char> StrainEnergy::flipped_corners(const Function& delta) const {
  std::vector<char> result(vertex_count(), 0);
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    if (!flips(t, delta)) continue;
    for (const int v : triangles_[t].vertices) result[v] = 1;
  }
  return result;
}

void StrainEnergy::grow(std::vector<char>& marked, int rings) const {
  for (int ring = 0; ring < rings; ++ring) {
    const std::vector<char> before = marked;
    for (const Triangle& triangle : triangles_) {
      if (!any(before, triangle.vertices)) continue;
      for (const int v : triangle.vertices) marked[v] = 1;
    }
  }
}

// Gives the triangle the shape that it has under the map with these derivatives: from now on z is the coordinate in the
// plane of that map. A triangle that the map collapses has no shape to keep.
void StrainEnergy::Triangle::keep_shape(const Derivatives& map) {
  const double determinant = std::norm(map.a) - std::norm(map.b);
  if (!(std::abs(determinant) > kCollapsed * std::norm(map.a))) return;
  // The inverse of dw = a dz + b conj(dz), applied to the gradients and to the derivatives of the present map.
  for (Complex& g : gradients) g = (g * map.a - std::conj(g) * map.b) / determinant;
  const Complex a_before = a, b_before = b;
  a = (a_before * std::conj(map.a) - b_before * std::conj(map.b)) / determinant;
  b = (b_before * map.a - a_before * map.b) / determinant;
  keeps_shape = true;
  reversed = determinant < 0;
}

std::vector<StrainEnergy::Patch> StrainEnergy::around_flipped(const Function& delta, Rings rings) const {
  std::vector<char> inner = flipped_corners(delta), inside = inner;
  grow(inside, rings.all);
  if (rings.inner > 0)
    grow(inner, rings.inner);
  else
    inner.assign(vertex_count(), 0);
  mesh::UnionFind sets(vertex_count());
  const auto free_corner = [&](const Triangle& triangle) {
    return std::ranges::find_if(triangle.vertices, [&](int v) { return inside[v] != 0; });
  };
  for (const Triangle& triangle : triangles_) {
    for (auto i = free_corner(triangle); i < triangle.vertices.end(); ++i) {
      if (inside[*i]) sets.join(*free_corner(triangle), *i);
    }
  }
  std::vector<Patch> patches;
  std::vector<int> patch_of(vertex_count(), -1), number(vertex_count(), -1);
  for (int v = 0; v < vertex_count(); ++v) {
    if (!inside[v]) continue;
    const int lowest = sets.lowest(v);
    if (lowest == v) {
      patch_of[v] = static_cast<int>(patches.size());
      patches.emplace_back();
    }
    Patch& patch = patches[patch_of[v] = patch_of[lowest]];
    number[v] = patch.free_count++;
    patch.vertices.push_back(v);
  }
  std::vector<std::vector<int>> of_patch(patches.size());
  for (int t = 0; t < std::ssize(triangles_); ++t) {
    const auto corner = free_corner(triangles_[t]);
    if (corner != triangles_[t].vertices.end()) of_patch[patch_of[*corner]].push_back(t);
  }
  for (std::size_t p = 0; p < patches.size(); ++p) {
    Patch& patch = patches[p];
    patch.energy.log_size_ = log_size_;
    patch.energy.whole_area_ = whole_area_;
    for (const int t : of_patch[p]) {
      Triangle triangle = triangles_[t];
      const Derivatives before{triangle.a, triangle.b}, map = derivatives(t, delta);
      if (triangle.area > 0 && flipped(triangle, before)) patch.flipped_before += triangle.area;
      // delta becomes part of the map, so that the patch begins with the function 0.
      triangle.a = map.a;
      triangle.b = map.b;
      const bool is_inner = std::ranges::all_of(triangle.vertices, [&](int v) { return inner[v]; });
      if (is_inner && !triangle.at_pole) triangle.keep_shape(before);
      for (int& v : triangle.vertices) {
        if (number[v] < 0) {
          number[v] = static_cast<int>(patch.vertices.size());
          patch.vertices.push_back(v);
        }
        v = number[v];
      }
      patch.energy.triangles_.push_back(triangle);
      if (!turned_.empty()) patch.energy.turned_.push_back(turned_[t]);
    }
    for (std::size_t i = patch.free_count; i < patch.vertices.size(); ++i) number[patch.vertices[i]] = -1;
    patch.energy.find_stars(static_cast<int>(patch.vertices.size()));
  }
  return patches;
}

uv::UvArray evened(const mesh::Surface& surface, uv::UvArray uv, const Kept& kept, double evenness,
                   Execution& execution, const EveningOptions& options) {
  uv::UvArray result = uv::UvArray::Zero(surface.vertex_count, 2);
  if (evenness == 0) return result;
  const StrainEnergy energy(surface, uv, kept.poles, kept.turns, execution.workers());
  uv.resize(0, 2);  // the energy knows it, and its memory is free for the descent
  // The first weight of size with which no more area is flipped than before. If there is none, the map stays as it is.
  double vertex_steps = options.turning * std::max(surface.vertex_count, kFewVertices);
  for (const double factor : kFactors) {
    const Found found = least(surface, energy, kept, factor * lambda_of(evenness), options, vertex_steps, execution);
    if (found.flipped_more > 0) continue;
    for_rows(execution.workers(), surface.vertex_count,
             [&](int v) { result.row(v) << found.delta[v].real(), found.delta[v].imag(); });
    break;
  }
  return result;
}

double strain(const mesh::Surface& surface, const uv::UvArray& uv, const Kept& kept, double evenness,
              Execution& execution) {
  const StrainEnergy energy(surface, uv, kept.poles, kept.turns, execution.workers());
  Function gradient, at_corners;
  return energy(Function(surface.vertex_count, 0.0), lambda_of(evenness), gradient, at_corners, execution.workers())
      .energy;
}

}  // namespace holomorph::uv
