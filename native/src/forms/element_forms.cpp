#include "forms/element_forms.h"

#include <Eigen/Cholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/errors.h"
#include "linear/dense.h"
#include "mesh/components.h"
#include "solver/direct/direct_solver.h"

namespace holomorph::forms {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using forms::GramMatrix;
using forms::RowMajorMatrix;
using mesh::edge_of;
using mesh::HalfedgeHandle;

namespace {

// Faces whose matrices are made by one thread before it takes others.
constexpr int kFaces = 32;

double cube(Index n) { return static_cast<double>(n) * static_cast<double>(n) * static_cast<double>(n); }

}  // namespace

// The factor and the entries that it is made of take about 45 p^2 T log2 T bytes. There are p^2 / 2 unknowns for each
// face.
double bytes(double faces, int order, int forms) {
  constexpr double kFactor = 50, kCopies = 4;
  return order * order * faces * (kFactor * std::log2(faces + 1) + kCopies * 8 * forms / 2);
}

// What is left of the energy of a face when its inside is eliminated: by Schur, S = A_oo - A_oi A_ii^-1 A_io.
struct ElementForms::Condensed {
  MatrixXd S;
  MatrixXd inside;  ///< -A_ii^-1 A_io
};

ElementForms::ElementForms(const mesh::HalfEdges& half_edges, std::vector<mesh::FaceWeights> weights,
                           const topology::IntegerForms& classes, int natural, int order)
    : half_edges_(half_edges),
      weights_(std::move(weights)),
      classes_(classes),
      natural_(natural),
      reference_(reference_element(order)) {}

std::vector<int> ElementForms::families() const {
  std::vector<int> result{natural_};
  if (classes_.form_count > natural_) result.push_back(classes_.form_count - natural_);
  return result;
}

std::array<HalfedgeHandle, 3> ElementForms::sides(int face) const {
  const HalfedgeHandle h = half_edges_.halfedge_handle(mesh::FaceHandle(face)), after = mesh::next(half_edges_, h);
  return {h, after, mesh::next(half_edges_, after)};
}

MatrixXd ElementForms::combined(const Stiffness& w, bool absolute) const {
  const auto& [R0, R1, R2] = reference_.stiffness;
  if (absolute) return w[0] * R0.cwiseAbs() + w[1] * R1.cwiseAbs() + w[2] * R2.cwiseAbs();
  return w[0] * R0 + w[1] * R1 + w[2] * R2;
}

// 2 x #forms: the classes along l1 and l2, from corner 0.
MatrixXd ElementForms::class_values(int face) const {
  MatrixXd eta = MatrixXd::Zero(2, classes_.form_count);
  const auto [h0, h1, h2] = sides(face);
  for (const auto& [form, value] : classes_.rows[edge_of(h0)]) eta(0, form) = mesh::sign(h0) * value;
  for (const auto& [form, value] : classes_.rows[edge_of(h2)]) eta(1, form) = -mesh::sign(h2) * value;
  return eta;
}

ElementForms::Condensed ElementForms::condensed(int face) const {
  const MatrixXd A = combined(weights_[face].cotangents);
  const int outer = reference_.outer(), inner = reference_.inner();
  if (inner == 0) return {A, MatrixXd(0, outer)};
  const Eigen::LLT<MatrixXd> factor(A.bottomRightCorner(inner, inner));
  if (factor.info() != Eigen::Success) throw SolverError("a triangle is too thin for polynomials of this degree");
  MatrixXd inside = -factor.solve(A.bottomLeftCorner(inner, outer));
  return {A.topLeftCorner(outer, outer) + A.topRightCorner(outer, inner) * inside, std::move(inside)};
}

// The unknowns of corners 0, 1, 2 and of the functions of sides; the signs of the latter.
std::vector<Index> ElementForms::outer_unknowns(int face, VectorXd& signs) const {
  std::vector<Index> result;
  signs.setOnes(reference_.outer() + 1);
  const auto side = sides(face);
  for (const HalfedgeHandle h : side) result.push_back(vertex_begin() + mesh::from_vertex(half_edges_, h));
  for (const HalfedgeHandle h : side) {
    for (int k = 0; k < reference_.of_side(); ++k) {  // degree k + 2
      if (k % 2 == 1) signs[static_cast<Index>(result.size())] = mesh::sign(h);
      result.push_back(static_cast<Index>(edge_of(h)) * reference_.of_side() + k);
    }
  }
  return result;
}

// The differences along l1 and l2, and the coefficients on sides: all that forms are outside the inside.
MatrixXd ElementForms::outer_values(int face, const RowMajorMatrix& functions) const {
  VectorXd signs;
  const auto unknowns = outer_unknowns(face, signs);
  const int outer = reference_.outer();
  MatrixXd X(outer, functions.cols());
  const auto origin = functions.row(unknowns[0]);
  X.row(0) = functions.row(unknowns[1]) - origin;
  X.row(1) = functions.row(unknowns[2]) - origin;
  X.topRows(2) += class_values(face);
  for (int i = 2; i < outer; ++i) X.row(i) = signs[i + 1] * functions.row(unknowns[i + 1]);
  return X;
}

MatrixXd ElementForms::values(int face, const RowMajorMatrix& functions) const {
  MatrixXd X(reference_.count(), functions.cols());
  X << outer_values(face, functions),
      functions.middleRows(unknowns() + static_cast<Index>(face) * reference_.inner(), reference_.inner());
  return X;
}

std::vector<int> ElementForms::fixed_unknowns() const {
  std::vector<int> fixed;
  for (int e = 0; e < static_cast<int>(half_edges_.n_edges()); ++e) {
    if (!half_edges_.is_boundary(mesh::EdgeHandle(e))) continue;
    for (int k = 0; k < reference_.of_side(); ++k) fixed.push_back(e * reference_.of_side() + k);
  }
  // The last one is a vertex: the solver fixes it in natural problems, too.
  for (const int v : mesh::boundary_vertices(half_edges_)) fixed.push_back(static_cast<int>(vertex_begin()) + v);
  return fixed;
}

// The condensed energies of all faces and the right-hand sides, face by face in their order.
ElementForms::System ElementForms::assembled(Execution& execution) const {
  const int outer = reference_.outer(), size = outer + 1;
  std::vector<Eigen::Triplet<double, int>> entries;
  entries.reserve(static_cast<std::size_t>(faces()) * size * size);
  System system{{}, MatrixXd::Zero(unknowns(), classes_.form_count)};
  const auto add = [&](int face, const MatrixXd& S) {
    // In the values at all corners: the differences along l1 and l2 are theirs less that at corner 0.
    MatrixXd K(size, size);
    K.bottomRightCorner(outer, outer) = S;
    K.row(0).tail(outer) = -(S.row(0) + S.row(1));
    K.col(0).tail(outer) = K.row(0).tail(outer).transpose();
    K(0, 0) = -(K(0, 1) + K(0, 2));
    VectorXd signs;
    const auto unknown = outer_unknowns(face, signs);
    K = signs.asDiagonal() * K * signs.asDiagonal();
    const MatrixXd b = -K.middleCols(1, 2) * class_values(face);
    for (int i = 0; i < size; ++i) {
      system.B.row(unknown[i]) += b.row(i);
      for (int j = 0; j < size; ++j)
        entries.emplace_back(static_cast<int>(unknown[i]), static_cast<int>(unknown[j]), K(i, j));
    }
  };
  std::vector<std::vector<MatrixXd>> slots(forms::kBatch);
  int face = 0;
  forms::for_blocks<kFaces>(
      faces(), execution, 0, 0.75,
      [&](int slot, int begin, int end) {
        slots[slot].clear();
        for (int f = begin; f < end; ++f) slots[slot].push_back(condensed(f).S);
      },
      [&](int slot) {
        for (const MatrixXd& S : slots[slot]) add(face++, S);
      });
  Execution::count(static_cast<double>(faces()) * cube(reference_.count()) / 4);
  // The flux of a form sums to 0 over the vertices. Where all forms are harmonic from the start, B is rounding alone.
  auto fluxes = system.B.bottomRows(static_cast<Index>(half_edges_.n_vertices()));
  fluxes.leftCols(natural_).rowwise() -= fluxes.leftCols(natural_).colwise().mean().eval();
  Eigen::SparseMatrix<double> matrix(unknowns(), unknowns());
  matrix.setFromTriplets(entries.begin(), entries.end());
  system.L.starts.assign(matrix.outerIndexPtr(), matrix.outerIndexPtr() + matrix.cols() + 1);
  system.L.columns.assign(matrix.innerIndexPtr(), matrix.innerIndexPtr() + matrix.nonZeros());
  system.L.weights.assign(matrix.valuePtr(), matrix.valuePtr() + matrix.nonZeros());
  execution.report(1);
  return system;
}

RowMajorMatrix ElementForms::solve(Execution& execution) const {
  const int count = classes_.form_count, inner = reference_.inner();
  execution.part(0, 0.4);
  System system = assembled(execution);
  execution.part(0.4, 0.9);
  const auto solver = solver::make_direct_solver(std::move(system.L), fixed_unknowns(), execution);
  std::vector<solver::Condition> conditions(count, solver::Condition::natural);
  std::fill(conditions.begin() + natural_, conditions.end(), solver::Condition::dirichlet);
  RowMajorMatrix functions(unknowns() + static_cast<Index>(faces()) * inner, count);
  // Dirichlet functions are exactly 0 on the boundary: only such ones are admissible.
  functions.topRows(unknowns()) = solver->solve(system.B, conditions, execution);
  execution.part(0.9, 1);
  if (inner == 0) return functions;
  forms::for_blocks<kFaces>(
      faces(), execution, 0, 1,
      [&](int, int begin, int end) {
        for (int f = begin; f < end; ++f)
          functions.middleRows(unknowns() + static_cast<Index>(f) * inner, inner) =
              condensed(f).inside * outer_values(f, functions);
      },
      [](int) {});
  return functions;
}

// The rounding of a product x A y, x and y of N numbers: 1 unit of the entries of the reference matrices, 1 of their
// products with cotangents, 2 of their sum, N - 1 and 1 of each of both products.
std::vector<GramMatrix> ElementForms::gram_matrices(const RowMajorMatrix& functions, Execution& execution) const {
  const std::vector<int> sizes = families();
  const auto zero = [&] {
    std::vector<GramMatrix> result;
    for (const int n : sizes)
      result.push_back({MatrixXd::Zero(n, n), MatrixXd::Zero(n, n), VectorXd::Zero(n), VectorXd::Zero(n), 0});
    return result;
  };
  const auto add = [](std::vector<GramMatrix>& sums, const std::vector<GramMatrix>& parts) {
    for (std::size_t i = 0; i < sums.size(); ++i) {
      sums[i].value += parts[i].value;
      sums[i].uncertain += parts[i].uncertain;
      sums[i].size += parts[i].size;
      sums[i].cut_size += parts[i].cut_size;
    }
  };
  std::vector<GramMatrix> total = zero();
  std::vector<std::vector<GramMatrix>> slots(forms::kBatch, zero());
  forms::for_blocks<kFaces>(
      faces(), execution, 0, 1,
      [&](int slot, int begin, int end) {
        auto& sums = slots[slot] = zero();
        for (int f = begin; f < end; ++f) {
          const auto& [cotangents, errors] = weights_[f];
          const MatrixXd X = values(f, functions), eta = class_values(f).cwiseAbs(), absolute = X.cwiseAbs();
          Stiffness sum;
          for (int i = 0; i < 3; ++i) sum[i] = std::abs(cotangents[i]) + std::abs(errors[i]);
          const MatrixXd AX = combined(cotangents) * X, UX = combined(errors) * X, M = combined(sum, true);
          const VectorXd size = absolute.cwiseProduct(M * absolute).colwise().sum();
          const VectorXd cut = eta.cwiseProduct(M.topLeftCorner(2, 2) * eta).colwise().sum();
          for (std::size_t i = 0, first = 0; i < sizes.size(); first += sizes[i++]) {
            const auto own = X.middleCols(first, sizes[i]);
            sums[i].value += own.transpose() * AX.middleCols(first, sizes[i]);
            sums[i].uncertain += own.transpose() * UX.middleCols(first, sizes[i]);
            sums[i].size += size.segment(first, sizes[i]);
            sums[i].cut_size += cut.segment(first, sizes[i]);
          }
        }
      },
      [&](int slot) { add(total, slots[slot]); });
  for (GramMatrix& gram : total) {
    gram.value = (gram.value + gram.value.transpose()).eval() / 2;
    gram.uncertain = (gram.uncertain + gram.uncertain.transpose()).eval() / 2;
    gram.summands = 2 * reference_.count() + 4 + kFaces + faces() / kFaces + 1;
  }
  Execution::count(static_cast<double>(faces()) * cube(reference_.count()) / reference_.count() * classes_.form_count);
  return total;
}

std::vector<double> ElementForms::gaps(const RowMajorMatrix& functions, const std::vector<MatrixXd>& gram,
                                       Execution& execution) const {
  const Index own = natural_, other = gram.size() > 1 ? natural_ : 0;  // where the families' columns begin
  std::vector<double> result(faces());
  std::vector<MatrixXd> slots(forms::kBatch);
  MatrixXd W = MatrixXd::Zero(own, own);
  forms::for_blocks<kFaces>(
      faces(), execution, 0, 0.5,
      [&](int slot, int begin, int end) {
        slots[slot] = MatrixXd::Zero(own, own);
        for (int f = begin; f < end; ++f) {
          const MatrixXd X = values(f, functions);
          slots[slot] += X.leftCols(own).transpose() * reference_.wedge * X.middleCols(other, own);
        }
      },
      [&](int slot) { W += slots[slot]; });
  // Orthonormal combinations are the columns of h Q and h' P, P = C^T Q, with Q^T G Q = 1 and C = W G'^-1.
  const Eigen::LLT<MatrixXd> root(gram[0]);
  const MatrixXd Q = root.matrixU().solve(MatrixXd::Identity(own, own));
  const MatrixXd P = linear::solve(gram.back(), W.transpose()) * Q;
  forms::for_blocks<kFaces>(
      faces(), execution, 0.5, 1,
      [&](int, int begin, int end) {
        for (int f = begin; f < end; ++f) {
          const MatrixXd X = values(f, functions), A = combined(weights_[f].cotangents);
          const MatrixXd Y = X.leftCols(own) * Q, Z = X.middleCols(other, own) * P;
          const double gap =
              (Y.cwiseProduct(A * Y) + Z.cwiseProduct(A * Z) - 2 * Y.cwiseProduct(reference_.wedge * Z)).sum();
          result[f] = std::max(gap, 0.0);
        }
      },
      [](int) {});
  Execution::count(static_cast<double>(faces()) * cube(reference_.count()) / reference_.count() * own * 4);
  return result;
}

}  // namespace holomorph::forms
