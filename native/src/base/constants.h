// Numbers that all rooms share.
#pragma once

#include <complex>
#include <limits>
#include <numbers>

namespace holomorph {

using Complex = std::complex<double>;

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kTwoPi = 2 * std::numbers::pi;
inline constexpr double kUnit = std::numeric_limits<double>::epsilon() / 2;  ///< the unit of rounding

}  // namespace holomorph
