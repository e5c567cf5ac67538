#include "evening/unknowns.h"

#include <algorithm>

namespace holomorph::evening {

void Unknowns::add(int p, int q, double value, std::vector<Eigen::Triplet<double>>& entries) const {
  const int a = number[p], b = number[q];
  if (a < 0 || b < 0 || value == 0) return;
  const double signed_value = sign[p] * sign[q] * value;
  if (a == b)
    entries.emplace_back(a, a, p == q ? signed_value : 2 * signed_value);
  else
    entries.emplace_back(std::max(a, b), std::min(a, b), signed_value);
}

void Unknowns::add_difference(int a, int b, double weight, Complex turn,
                              std::vector<Eigen::Triplet<double>>& entries) const {
  for (const int part : {0, 1}) {
    add(2 * a + part, 2 * a + part, weight, entries);
    add(2 * b + part, 2 * b + part, weight, entries);
    if (a != b) add(2 * a + part, 2 * b + part, -weight * turn.real(), entries);
  }
  if (a == b) return;
  add(2 * a, 2 * b + 1, weight * turn.imag(), entries);
  add(2 * a + 1, 2 * b, -weight * turn.imag(), entries);
}

Function Unknowns::spread(const Eigen::VectorXd& x) const {
  Function function(number.size() / 2, 0.0);
  for (std::size_t v = 0; v < function.size(); ++v) {
    const auto part = [&](std::size_t p) { return number[p] < 0 ? 0.0 : sign[p] * x[number[p]]; };
    function[v] = {part(2 * v), part(2 * v + 1)};
  }
  return function;
}

Eigen::VectorXd Unknowns::gathered(const Function& function) const {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(count);
  for (std::size_t v = 0; v < function.size(); ++v) {
    const double parts[2] = {function[v].real(), function[v].imag()};
    for (std::size_t i = 0; i < 2; ++i) {
      if (number[2 * v + i] >= 0) x[number[2 * v + i]] += sign[2 * v + i] * parts[i];
    }
  }
  return x;
}

std::vector<char> Unknowns::shared() const {
  std::vector<int> parts(count, 0);
  for (const int n : number) {
    if (n >= 0) ++parts[n];
  }
  std::vector<char> result(number.size(), 0);
  for (std::size_t p = 0; p < number.size(); ++p) result[p] = number[p] >= 0 && parts[number[p]] > 1;
  return result;
}

}  // namespace holomorph::evening
