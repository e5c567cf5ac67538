#include "tiling/rounding/texture_lattice.h"

#include <Eigen/LU>
#include <cmath>
#include <numbers>

namespace holomorph::tiling {

constexpr double kSame = 1e-9;  // relative distance up to which points count as the same

Eigen::Vector2d TextureLattice::coordinates(Complex z) const {
  Eigen::Matrix2d A;
  A << a.real(), b.real(), a.imag(), b.imag();
  return A.inverse() * Eigen::Vector2d(z.real(), z.imag());
}

Complex TextureLattice::nearest(Complex z) const {
  const Eigen::Vector2d c = coordinates(z);
  return point(std::round(c[0]), std::round(c[1]));
}

bool TextureLattice::has(Complex z) const { return std::abs(z - nearest(z)) < kSame * std::abs(z); }

double TextureLattice::symmetry() const {
  for (const int part : {3, 2}) {
    const Complex turn = std::polar(1.0, std::numbers::pi / part);
    if (has(turn * a) && has(turn * b)) return std::numbers::pi / part;
  }
  return std::numbers::pi;
}

bool TextureLattice::is_mirrored() const { return has(std::conj(a)) && has(std::conj(b)); }

}  // namespace holomorph::tiling
