// Elements of order p on the reference triangle: a hierarchical basis of integrated Legendre polynomials, whose
// products are rational numbers.
#pragma once

#include <Eigen/Core>
#include <array>

namespace holomorph::forms {

inline constexpr int kMostOrder = 10;

/// The polynomials of degree p on a triangle with the barycentric coordinates l0, l1, l2, up to a constant; side i goes
/// from corner i to corner i + 1. In this order:
///     l1, l2;
///     of side i, for n = 2 .. p:  P_n(s, t) - t^2 P_(n-2)(s, t),  s = l_(i+1) - l_i, t = l_(i+1) + l_i;
///     inside, for a = 2 .. p - 1, b = 1 .. p - a:  that of side 0 and n = a, times l2 Q_(b-1)(2 l2 - 1).
/// P_n(s, t) = t^n P_n(s / t), P_n Legendre's, Q_n Jacobi's polynomials P_n^(2 a - 2, 1) (Beuchler & Schoeberl 2006,
/// doi:10.1007/s00211-006-0681-2). Run along in the other direction, those of a side are (-1)^n times as large.
struct ReferenceElement {
  int order = 1;
  /// [i]: integrals of the products of derivatives along side i, over the triangle of the area 1 / 2. Each entry is
  /// the rational number, rounded once.
  std::array<Eigen::MatrixXd, 3> stiffness;
  Eigen::MatrixXd wedge;  ///< integrals of d phi_m ^ d phi_n

  int of_side() const { return order - 1; }
  int outer() const { return 2 + 3 * of_side(); }  ///< functions that are not 0 on all sides; they come first
  int inner() const { return (order - 1) * (order - 2) / 2; }
  int count() const { return outer() + inner(); }
};

/// Made once for each order. @pre 1 <= order <= kMostOrder
const ReferenceElement& reference_element(int order);

}  // namespace holomorph::forms
