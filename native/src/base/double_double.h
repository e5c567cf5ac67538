// Numbers in twice the working precision: each is an unevaluated sum high + low, |low| <= ulp(high) / 2 (Dekker 1971,
// doi:10.1007/BF01397083). From additions and multiplications of doubles alone: the same bits on every processor.
#pragma once

#include <cmath>
#include <utility>

namespace holomorph {

/// The upper 26 bits of a double, and the rest: products of such halves are exact.
inline std::pair<double, double> halves(double a) {
  constexpr double kSplit = 134217729;  // 2^27 + 1
  const double shifted = kSplit * a, upper = shifted - (shifted - a);
  return {upper, a - upper};
}

struct DoubleDouble {
  double high = 0, low = 0;

  double value() const { return high + low; }
};

/// a + b exactly. @pre |a| >= |b|, or a = 0
inline DoubleDouble quick_sum(double a, double b) {
  const double sum = a + b;
  return {sum, b - (sum - a)};
}

/// a + b exactly.
inline DoubleDouble exact_sum(double a, double b) {
  const double sum = a + b, taken = sum - a;
  return {sum, (a - (sum - taken)) + (b - taken)};
}

/// a b exactly.
inline DoubleDouble exact_product(double a, double b) {
  const auto [p, q] = halves(a);
  const auto [u, v] = halves(b);
  const double product = a * b;
  return {product, ((p * u - product) + p * v + q * u) + q * v};
}

inline DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble high = exact_sum(a.high, b.high), low = exact_sum(a.low, b.low);
  const DoubleDouble sum = quick_sum(high.high, high.low + low.high);
  return quick_sum(sum.high, sum.low + low.low);
}

inline DoubleDouble operator-(const DoubleDouble& a) { return {-a.high, -a.low}; }
inline DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) { return a + -b; }

inline DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble product = exact_product(a.high, b.high);
  return quick_sum(product.high, product.low + (a.high * b.low + a.low * b.high));
}

inline DoubleDouble operator/(const DoubleDouble& a, const DoubleDouble& b) {
  const double first = a.high / b.high;
  const DoubleDouble rest = a - DoubleDouble{first} * b;
  const double second = rest.high / b.high;
  const DoubleDouble last = rest - DoubleDouble{second} * b;
  return quick_sum(first, second) + DoubleDouble{last.high / b.high};
}

inline DoubleDouble sqrt(const DoubleDouble& a) {
  if (!(a.high > 0)) return {};
  const double root = std::sqrt(a.high);
  return exact_sum(root, (a - exact_product(root, root)).high / (2 * root));
}

}  // namespace holomorph
