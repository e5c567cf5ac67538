// The map nearest to given frames, and the whole numbers for it.
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "base/execution.h"
#include "solver/direct/sparse_cholesky.h"
#include "tiling/cones/scale_form.h"
#include "tiling/cones/turned_space.h"

namespace holomorph::tiling {

/// The functions y and whole numbers z of a TurnedSpace that minimise, over the triangles,
///     sum A e^(-2u) |grad x - f e^(u - i theta)|^2 = |f|^2 constant + |B (z - z0(f))|^2,
/// where the factor f says how large and how turned the map is to be.
class NearestMap {
 public:
  /// @param turns whether the map may be turned from its frames: where it has lines it may not
  /// @throws SolverError @pre the others outlive it
  NearestMap(const Net& net, const Frames& frames, const TurnedSpace& space, bool turns, Execution& execution);

  /// A factor and whole numbers; error: how far they are from the map without whole numbers, over |f|^2 and the area,
  /// and the price of another size than the one asked for.
  struct Rounded {
    double error = 0;
    Complex factor;
    linear::IntegerVector z;
    bool is_level = false;  ///< nearest to the frames that are pulled level
  };
  /// The best of a few sizes and angles near a factor, each whole numbers once, the nearest first; in turn for the
  /// frames and for those that are pulled level.
  std::vector<Rounded> round(Complex factor) const;

  /// #V, y in the plane: x(corner) is this turned, and the offset. @param is_level nearest to the frames pulled level
  Eigen::VectorXcd functions(const Rounded& rounded, bool is_level) const;

 private:
  const uv::Unknowns& unknowns_;
  const bool turns_;
  const double area_;  // of the surface
  std::vector<Rounded> rounded(Complex factor, const Eigen::MatrixXd& g) const;

  // #unknowns x (2 #targets + #z): for f = 1 and f = i, z = 0, and by what it falls for each z
  Eigen::SparseMatrix<double> rhs_;
  struct Solving {
    solver::SparseCholesky factor;
    std::mutex one_at_a_time;
  };
  std::unique_ptr<Solving> solving_ = std::make_unique<Solving>();
  Eigen::MatrixXd B_;  // #z x #z
  Eigen::MatrixXd g_;  // #z x 2 #targets: B^T B z0(f) = g (Re f, Im f); the frames, and those pulled level
};

/// The factor at which rows are level in the mean where the surface is steep, of modulus 1.
Complex level_factor(const Net& net, const Frames& frames, int k, const std::vector<std::array<double, 3>>& points,
                     const Along& along);

/// The complex number that a turn of the lattice is, r times.
Complex turned_by(const TurnLattice& lattice, int r);

}  // namespace holomorph::tiling
