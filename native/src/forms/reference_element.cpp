#include "forms/reference_element.h"

#include <cmath>
#include <mutex>
#include <vector>

#include "base/double_double.h"

namespace holomorph::forms {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

// sum c_(ij) l0^(d-i-j) l1^i l2^j, a homogeneous polynomial of degree d. All numbers are integers below 2^53.
class Polynomial {
 public:
  explicit Polynomial(int degree) : degree_(degree), c_(static_cast<std::size_t>(degree + 1) * (degree + 1), 0.0) {}

  int degree() const { return degree_; }
  double& at(int i, int j) { return c_[static_cast<std::size_t>(i) * (degree_ + 1) + j]; }
  double at(int i, int j) const { return c_[static_cast<std::size_t>(i) * (degree_ + 1) + j]; }

 private:
  int degree_;
  std::vector<double> c_;
};

template <class Visit>
void for_terms(int degree, const Visit& visit) {
  for (int i = 0; i <= degree; ++i) {
    for (int j = 0; i + j <= degree; ++j) visit(i, j);
  }
}

Polynomial operator*(const Polynomial& f, const Polynomial& g) {
  Polynomial product(f.degree() + g.degree());
  for_terms(f.degree(), [&](int i, int j) {
    if (f.at(i, j) == 0) return;
    for_terms(g.degree(), [&](int k, int l) { product.at(i + k, j + l) += f.at(i, j) * g.at(k, l); });
  });
  return product;
}

Polynomial operator+(Polynomial f, const Polynomial& g) {
  for_terms(f.degree(), [&](int i, int j) { f.at(i, j) += g.at(i, j); });
  return f;
}

Polynomial scaled(double factor, Polynomial f) {
  for_terms(f.degree(), [&](int i, int j) { f.at(i, j) *= factor; });
  return f;
}

Polynomial coordinate(int corner) {
  Polynomial f(1);
  (corner == 0 ? f.at(0, 0) : corner == 1 ? f.at(1, 0) : f.at(0, 1)) = 1;
  return f;
}

Polynomial power(const Polynomial& f, int n) {
  Polynomial result(0);
  result.at(0, 0) = 1;
  for (int k = 0; k < n; ++k) result = result * f;
  return result;
}

double binomial(int n, int k) {
  double value = 1;
  for (int i = 1; i <= k; ++i) value = value * (n - k + i) / i;
  return value;
}

// t^n P_n(s / t) = sum_k (-1)^(n-k) binomial(n, k)^2 u^k v^(n-k), with s = u - v and t = u + v.
Polynomial legendre(int n, const Polynomial& u, const Polynomial& v) {
  Polynomial sum(n);
  for (int k = 0; k <= n; ++k) {
    const double factor = binomial(n, k) * binomial(n, k) * ((n - k) % 2 ? -1 : 1);
    sum = sum + scaled(factor, power(u, k) * power(v, n - k));
  }
  return sum;
}

Polynomial of_side(int n, int i) {
  const Polynomial u = coordinate((i + 1) % 3), v = coordinate(i);
  return legendre(n, u, v) + scaled(-1, power(u + v, 2) * legendre(n - 2, u, v));
}

// P_n^(alpha, 1)(2 l2 - 1) = sum_k binomial(n + alpha, n - k) binomial(n + 1, k) (-l0 - l1)^k l2^(n-k).
Polynomial jacobi(int n, int alpha) {
  const Polynomial u = coordinate(2), v = scaled(-1, coordinate(0) + coordinate(1));
  Polynomial sum(n);
  for (int k = 0; k <= n; ++k)
    sum = sum + scaled(binomial(n + alpha, n - k) * binomial(n + 1, k), power(v, k) * power(u, n - k));
  return sum;
}

std::vector<Polynomial> basis(int order) {
  std::vector<Polynomial> result{coordinate(1), coordinate(2)};
  for (int i = 0; i < 3; ++i) {
    for (int n = 2; n <= order; ++n) result.push_back(of_side(n, i));
  }
  for (int a = 2; a < order; ++a) {
    for (int b = 1; a + b <= order; ++b) result.push_back(of_side(a, 0) * coordinate(2) * jacobi(b - 1, 2 * a - 2));
  }
  return result;
}

// The derivative by l_(i+1) less that by l_i, the direction of side i.
Polynomial along_side(const Polynomial& f, int i) {
  Polynomial result(f.degree() - 1);
  const auto add = [&](int corner, double sign) {
    for_terms(f.degree(), [&](int j, int k) {
      const int exponent = corner == 0 ? f.degree() - j - k : corner == 1 ? j : k;
      if (exponent > 0) result.at(j - (corner == 1), k - (corner == 2)) += sign * exponent * f.at(j, k);
    });
  };
  add((i + 1) % 3, 1);
  add(i, -1);
  return result;
}

// The derivatives of all functions along side i as coefficients of monomials of degree p - 1: 1 = (l0 + l1 + l2)^k.
MatrixXd derivatives(const std::vector<Polynomial>& functions, int i, int degree) {
  MatrixXd rows(functions.size(), (degree + 1) * (degree + 2) / 2);
  const Polynomial one = coordinate(0) + coordinate(1) + coordinate(2);
  for (std::size_t m = 0; m < functions.size(); ++m) {
    const Polynomial f = along_side(functions[m], i), whole = f * power(one, degree - f.degree());
    Index column = 0;
    for_terms(degree, [&](int j, int k) { rows(static_cast<Index>(m), column++) = whole.at(j, k); });
  }
  return rows;
}

// Integrals of the products of monomials of this degree: a! b! c! / (a + b + c + 2)!.
std::vector<DoubleDouble> moments(int degree) {
  const auto factorial = [](int n) {
    DoubleDouble value{1};
    for (int i = 2; i <= n; ++i) value = value * DoubleDouble{static_cast<double>(i)};
    return value;
  };
  std::vector<DoubleDouble> result;
  for_terms(degree, [&](int i, int j) {
    for_terms(degree, [&](int k, int l) {
      const int b = i + k, c = j + l, a = 2 * degree - b - c;
      result.push_back(factorial(a) * factorial(b) * factorial(c) / factorial(2 * degree + 2));
    });
  });
  return result;
}

// F M G^T in twice the precision, rounded once: integers and moments cancel to some ten digits.
MatrixXd products(const MatrixXd& F, const std::vector<DoubleDouble>& M, const MatrixXd& G) {
  constexpr double kZero = 0x1p-60;  // what is 0 exactly is less; all else is far more
  const Index terms = F.cols();
  MatrixXd result(F.rows(), G.rows());
  std::vector<DoubleDouble> row(terms);
  for (Index m = 0; m < F.rows(); ++m) {
    row.assign(terms, {});
    for (Index t = 0; t < terms; ++t) {
      if (F(m, t) == 0) continue;
      for (Index s = 0; s < terms; ++s) row[s] = row[s] + DoubleDouble{F(m, t)} * M[t * terms + s];
    }
    for (Index n = 0; n < G.rows(); ++n) {
      DoubleDouble sum;
      for (Index s = 0; s < terms; ++s) {
        if (G(n, s) != 0) sum = sum + DoubleDouble{G(n, s)} * row[s];
      }
      result(m, n) = std::abs(sum.value()) < kZero ? 0 : sum.value();
    }
  }
  return result;
}

ReferenceElement made(int order) {
  ReferenceElement element;
  element.order = order;
  const auto functions = basis(order);
  const auto M = moments(order - 1);
  std::array<MatrixXd, 3> along;
  for (int i = 0; i < 3; ++i) {
    along[i] = derivatives(functions, i, order - 1);
    element.stiffness[i] = products(along[i], M, along[i]);
  }
  // d phi ^ d psi = (phi_x psi_y - phi_y psi_x) dx dy, x along side 0 and y against side 2.
  const MatrixXd half = products(along[0], M, along[2]);
  element.wedge = half.transpose() - half;
  return element;
}

}  // namespace

const ReferenceElement& reference_element(int order) {
  static std::array<ReferenceElement, kMostOrder + 1> elements;
  static std::array<std::once_flag, kMostOrder + 1> flags;
  std::call_once(flags[order], [order] { elements[order] = made(order); });
  return elements[order];
}

}  // namespace holomorph::forms
