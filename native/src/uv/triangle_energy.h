// The energy by which evening weighs the shear of a triangle against its size; see StrainEnergy.
#pragma once

#include <array>
#include <complex>
#include <vector>

namespace holomorph::uv {

using Complex = std::complex<double>;

/// #T, for each corner the complex number of modulus 1 by which a function at its vertex is turned there. Across an
/// edge all three of a triangle differ by one turn. Empty: by none.
using CornerTurns = std::vector<std::array<Complex, 3>>;

/// The energy of a triangle of area 1 on which the map is a z + b conj(z). `by_a` and `by_b` are its derivatives by |a|
/// and |b|, divided by |a| and |b|.
struct TriangleEnergy {
  double value, by_a, by_b;
};

/// @param square_a |a|^2, positive. @param square_b |b|^2; larger where the triangle is flipped
/// @param log_size 2 ln s0
TriangleEnergy triangle_energy(double square_a, double square_b, double lambda, double log_size);

/// Returns how much larger the second derivatives are than where the map is conformal and of the mean size.
/// @param ratio |b| / |a|. @param size ln(s1 s2 / s0^2)
double stiffness(double ratio, double size, double lambda);

}  // namespace holomorph::uv
