#include "moduli/period_lattice.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include "base/errors.h"
#include "forms/certain_bounds.h"
#include "linear/dense.h"

namespace holomorph::moduli {

using Eigen::MatrixXd;

namespace {

using Eigen::Index;

constexpr double kLargestInteger = 9007199254740992;  // 2^53

// Exact: the entries of a unimodular inverse are integers, and the product is checked.
IntegerMatrix unimodular_inverse(const IntegerMatrix& A) {
  const MatrixXd inverse = linear::inverse(MatrixXd(A.cast<double>()));
  if (!(inverse.cwiseAbs().maxCoeff() < kLargestInteger)) throw Error("the lattice needs integers beyond 2^53");
  const IntegerMatrix rounded = inverse.array().round().matrix().cast<std::int64_t>();
  if (checked_product(A, rounded) != IntegerMatrix::Identity(A.rows(), A.cols()))
    throw Error("the basis of the lattice of periods is too badly conditioned");
  return rounded;
}

MatrixXd in_basis(const IntegerMatrix& basis, const MatrixXd& form) {
  const MatrixXd T = basis.cast<double>();
  return forms::symmetric(T * form * T.transpose());
}

}  // namespace

LogRatios log_ratios(const MatrixXd& A, const MatrixXd& B) {
  const linear::Cholesky root(B);
  if (!root.succeeded())
    throw SolverError("the energies of " + std::to_string(B.rows()) + " classes are not positive definite");
  // The eigenvalues of L^-1 A L^-T, B = L L^T, are the stationary values of x A x / x B x.
  const MatrixXd both = root.solve_lower(root.solve_lower(A).transpose());
  const Eigen::VectorXd values = linear::eigenvalues((both + both.transpose()) / 2);
  const auto log = [](double x) { return x > 0 ? std::log(x) : -std::numeric_limits<double>::infinity(); };
  return {log(values.minCoeff()), log(values.maxCoeff())};
}

IntegerMatrix checked_product(const IntegerMatrix& A, const IntegerMatrix& B) {
  const MatrixXd most = A.cast<double>().cwiseAbs() * B.cast<double>().cwiseAbs();
  if (most.size() > 0 && !(most.maxCoeff() < kLargestInteger)) throw Error("the lattice needs integers beyond 2^53");
  return A * B;
}

IntegerMatrix short_basis(const MatrixXd& form, const std::function<void()>& tick) {
  // U^T U is the form, so that the columns of U span a lattice with these lengths and angles.
  const MatrixXd root = linear::Cholesky(form).upper();
  const auto reduced = linear::reduce(root, linear::kDelta, tick);
  const Eigen::VectorXd length = reduced.basis.colwise().norm();
  std::vector<Index> order(length.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](Index i, Index j) { return length[i] < length[j]; });
  return reduced.transform(Eigen::all, order).transpose();
}

PeriodLattice closed_lattice(const MatrixXd& G, const topology::IntegerMatrix& W) {
  const auto star = forms::projected_star(G, G, W.cast<double>());
  return {star.lower, G, star.natural_gram, W};
}

PeriodLattice bounded_lattice(const MatrixXd& G_N, const MatrixXd& G_D, const topology::IntegerMatrix& W, int genus) {
  const Index handles = 2 * genus;
  const MatrixXd real = W.cast<double>();
  IntegerMatrix pairing = IntegerMatrix::Zero(W.rows(), W.cols());
  pairing.topLeftCorner(handles, handles) = W.topLeftCorner(handles, handles);
  const MatrixXd lower = forms::symmetric(real.transpose() * forms::inverse(G_N) * real);
  return {lower, G_D, forms::projected_star(G_N, G_D, real).dirichlet_gram, pairing};
}

ReducedLattice reduced(const PeriodLattice& given, const std::function<void()>& tick) {
  const IntegerMatrix basis = short_basis(given.projected, tick);
  return {{in_basis(basis, given.lower), in_basis(basis, given.upper), in_basis(basis, given.projected),
           checked_product(checked_product(basis, given.pairing), basis.transpose())},
          basis,
          unimodular_inverse(basis)};
}

PeriodLattice projected_lattice(const PeriodLattice& lattice) {
  return {lattice.projected, lattice.projected, lattice.projected, lattice.pairing};
}

double radius(const PeriodLattice& lattice) {
  const auto above = log_ratios(lattice.upper, lattice.projected), below = log_ratios(lattice.projected, lattice.lower);
  return std::max({0.0, above.greatest, below.greatest});
}

}  // namespace holomorph::moduli
