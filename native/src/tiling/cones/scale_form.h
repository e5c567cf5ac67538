// The log scale of a flat metric with cones, as a quadratic form in the cones.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <functional>
#include <vector>

#include "mesh/surface.h"
#include "solver/direct/sparse_cholesky.h"
#include "tiling/cones/net.h"

namespace holomorph::tiling {

inline constexpr double kHeld = 1e6;  ///< weight of the direction at a line: it does not give way

/// The Laplacian of a net, on which each hole is one vertex. Solves L u = b: u is one number along each boundary loop,
/// and its mean over the surface is 0. What b has in sum is taken away evenly. It is natural at no boundary: nothing is
/// asked of the direction there.
class Laplace {
 public:
  /// @throws SolverError @pre the net outlives it
  explicit Laplace(const Net& net);

  /// @param B #V x n. @return #V x n
  Eigen::MatrixXd solve(const Eigen::MatrixXd& B);

 private:
  const Net& net_;
  std::vector<int> unknown_;  // #V
  Eigen::VectorXd area_;      // of the unknowns, 1 in sum
  solver::SparseCholesky factor_;
};

/// The vertex that stands for all of a boundary loop; otherwise the vertex itself.
inline int place_of(const Net& net, int v) { return net.hole[v] < 0 ? v : net.hole[v]; }

/// With n k-th turns missing at candidates, L u = (2 pi / k) n - defect has the integral of u^2, over an area of 1,
///     n^T Q n - 2 b^T n + constant.
/// With G the Green's function of a candidate and W the areas, Q is L^-1 W G at the other candidates: it is read off,
/// and kept for the next candidates.
class ScaleForm {
 public:
  /// @throws SolverError @pre the net outlives it
  ScaleForm(const Net& net, int k);

  /// Takes candidates: ascending vertices. @param report is called before every few solutions
  void take(const std::vector<int>& places, const std::function<void()>& report);

  int total() const { return total_; }   ///< the sum of n
  double unit() const { return unit_; }  ///< a k-th turn
  double constant() const { return constant_; }
  const Eigen::MatrixXd& Q() const { return Q_; }
  const Eigen::VectorXd& b() const { return b_; }
  /// The handles turn by turning + flux n, one row a loop of dual_loops.
  const Eigen::MatrixXd& flux() const { return flux_; }
  const Eigen::VectorXd& turning() const { return turning_; }

 private:
  Eigen::MatrixXd fluxes(const Eigen::MatrixXd& functions) const;
  void respond(const std::vector<int>& places, const std::function<void()>& report);

  const Net& net_;
  const double unit_;
  Laplace laplace_;
  const std::vector<std::vector<int>> loops_;
  int total_ = 0;
  double constant_ = 0;
  Eigen::VectorXd weights_, u0_, response0_, b_, turning_;
  Eigen::MatrixXd Q_, flux_;
  std::vector<Eigen::VectorXd> response_, flux_of_;  // #V, L^-1 W G and the flux of G; empty until it is a candidate
};

// Fields of k directions on the triangles, as smooth as can be and pulled level.

/// A vector in space that v runs along, so that rows are level where it is up, or u does.
struct Along {
  std::array<double, 3> vector;
  bool is_of_u = false;
};

/// The direction of u on each triangle for that, and the square of the sine between the triangle's normal and the
/// vector: 1 and 0 where these are one.
struct Level {
  std::vector<Complex> direction;  ///< #T, of length 1, in the plane of the triangle
  std::vector<double> steepness;   ///< #T
};
Level level_directions(const Net& net, const std::vector<std::array<double, 3>>& points, const Along& along);

/// The field z, one number of length 1 a triangle, whose k-th roots are k directions of u. It minimises its differences
/// across edges and its distance from level, weighted by how steep a triangle is: (A + weight W) z = weight W q. At
/// lines of the net u or v runs along them. @throws SolverError
std::vector<Complex> level_field(const Net& net, const std::vector<std::array<double, 3>>& points, int k,
                                 const Along& along, double weight);

/// Turns directions, angles of u on the triangles, towards level, but for k-th turns: by the delta that lowers
/// |d delta|^2 + weight times the integral of steepness sin(k (angle - level) / 2)^2, from 0 on. Continuous: what they
/// turn by across edges and around vertices stays the same. @param angle #T, changed. @throws SolverError
void pull_level(const Net& net, const std::vector<std::array<double, 3>>& points, int k, const Along& along,
                double weight, std::vector<double>& angle);

/// The cones of a field: how it turns on the way around a vertex. @return #V, k-th turns that are missing
std::vector<int> cones_of_field(const Net& net, const std::vector<Complex>& field, int k);

/// The weight of the difference of a field, or of frames, across a side.
double dual_weight(const Net& net, int side);

// Where cones may be: the vertices among which they are searched for.

/// Cones lie inside a patch, and holes at their places.
class ConePlaces {
 public:
  /// @param patch #V, the patch of each vertex, below 0 where no cone may be; empty: one patch
  /// @pre the surface and the net outlive this
  ConePlaces(const mesh::Surface& surface, const Net& net, std::vector<int> patch);

  bool have_patches() const { return have_patches_; }
  int patch(int v) const { return patch_[v]; }
  bool is_hole(int v) const { return net_.hole[v] == v; }
  bool is_place(int v) const;
  double squared_distance(int v, int w) const;

  /// Places whose squared distance is below this.
  std::vector<int> within(int v, double squared) const;
  /// For each of these vertices, those of them that are nearer than this, ascending; holes are near to none.
  std::vector<std::vector<std::size_t>> near(const std::vector<int>& vertices, double squared) const;

 private:
  const std::vector<std::array<double, 3>>& points_;
  const Net& net_;
  std::vector<int> patch_;
  const bool have_patches_;
};

}  // namespace holomorph::tiling
