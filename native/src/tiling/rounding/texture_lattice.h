// The lattice to which the jumps of a tiling belong.
#pragma once

#include "tiling/notation.h"

namespace holomorph::tiling {

/// The translations of the texture that leave it as it is: all integer combinations of two complex numbers.
struct TextureLattice {
  Complex a = 1, b = {0, 1};

  Complex point(double m, double n) const { return m * a + n * b; }
  /// Coordinates (m, n), integers at the lattice's points.
  Eigen::Vector2d coordinates(Complex z) const;
  Complex nearest(Complex z) const;
  bool has(Complex z) const;  ///< up to rounding, z not 0
  /// The least rotation that takes the lattice to itself, in radians: pi / 2, pi / 3 or, for most lattices, pi.
  double symmetry() const;
  /// Whether z -> conj z takes the lattice to itself.
  bool is_mirrored() const;
};

}  // namespace holomorph::tiling
