#include "evening/patch.h"

#include <algorithm>
#include <cmath>

#include "evening/descent.h"
#include "mesh/union_find.h"
#include "solver/direct/sparse_cholesky.h"

namespace holomorph::evening {
namespace {

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
// @return the area that is then flipped; delta and vertex_steps as above
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

}  // namespace

std::vector<char> StrainEnergy::near_flipped(const Function& delta, int rings) const {
  std::vector<char> inside(vertex_count(), 0);
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    if (!flips(t, delta)) continue;
    for (const int v : triangles_[t].vertices) inside[v] = 1;
  }
  // Each ring adds the triangles that touch those before.
  for (int ring = 0; ring < rings; ++ring) {
    const std::vector<char> before = inside;
    for (const Triangle& triangle : triangles_) {
      if (!any(before, triangle.vertices)) continue;
      for (const int v : triangle.vertices) inside[v] = 1;
    }
  }
  return inside;
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
  const std::vector<char> inside = near_flipped(delta, rings.all);
  const std::vector<char> inner =
      rings.inner > 0 ? near_flipped(delta, rings.inner) : std::vector<char>(vertex_count(), 0);
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

}  // namespace holomorph::evening
