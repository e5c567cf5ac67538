// SPDX-License-Identifier: GPL-3.0-or-later
// solvers MESH METHOD RHS TOLERANCE [RUNS]: a line of JSON about solving L x = b, L the cotan Laplacian of a closed
// surface, for RHS random right-hand sides, for each of so many runs, one if not said otherwise: the first two get new
// pages of memory from the system, the others find them in place. METHOD is one of
//   multigrid, direct          the library's own, with half-edges, Delaunay flips and assembly; the library itself asks
//                              multigrid for 1e-12
//   cholmod-amd, cholmod-metis supernodal with OpenBLAS on all cores, one vertex pinned
//   ldlt                       Eigen's SimplicialLDLT, one vertex pinned
//   cg, jacobi-cg              conjugate gradients, all right-hand sides at once, on all cores
//   matrix=FILE                writes the matrix and the right-hand sides for solvers written in Python
// One method per process, so that the peak memory is its own.
#include <Eigen/CholmodSupport>
#include <Eigen/SparseCholesky>
#include <cstdio>
#include <fstream>
#include <string>
#include <thread>

#include "linear_system.h"
#include "mesh/io/read.h"
#include "mesh/make_surface.h"
#include "process_memory.h"
#include "solver/solver_choice.h"

extern "C" void openblas_set_num_threads(int);

namespace {

using namespace holomorph;
using benchmarks::assembled;
using benchmarks::keep_memory;
using benchmarks::now;
using benchmarks::peak_bytes;
using benchmarks::right_hand_sides;
using Matrix = Eigen::SparseMatrix<double>;
using Rows = Eigen::SparseMatrix<double, Eigen::RowMajor>;
using Block = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

struct Result {
  std::string name;
  double assembly = 0, set_up = 0, solve = 0;  // seconds
  double peak_bytes = 0;                       // before the result is looked at
  int iterations = 0;
  double residual = 0;
};

constexpr int kMostIterations = 100'000;

double largest_residual(const Matrix& L, const Eigen::MatrixXd& X, const Eigen::MatrixXd& B) {
  return ((L * X - B).colwise().norm().array() / B.colwise().norm().array()).maxCoeff();
}

Result library(const mesh::Surface& surface, solver::Method method, int count, double tolerance, Matrix& L,
               Eigen::MatrixXd& B, Eigen::MatrixXd& X) {
  Result result;
  Execution silent;
  const double start = now();
  solver::Laplacian given = assembled(surface, true);
  result.assembly = now() - start;
  L = given.matrix();  // for the residual
  B = right_hand_sides(L.rows(), count);
  const double begin = now();
  const auto solver = solver::make_solver(method, std::move(given), {}, silent, tolerance);
  const double ready = now();
  const solver::Solution solution = solver->solve(B, solver::Condition::natural, silent);
  result.solve = now() - ready;
  result.peak_bytes = peak_bytes();
  X = solution;
  result.set_up = ready - begin;
  result.name = solver->name();
  result.iterations = solver->iterations();
  return result;
}

// The matrix without its first row and column, which makes it positive definite; lower triangle.
Matrix pinned(const Matrix& L) {
  const Matrix inner = L.bottomRightCorner(L.rows() - 1, L.cols() - 1);
  return inner.triangularView<Eigen::Lower>();
}

template <class Method>
Result factorised(Method& method, const Matrix& L, const Eigen::MatrixXd& B, Eigen::MatrixXd& X) {
  Result result;
  const Matrix lower = pinned(L);
  const double start = now();
  method.compute(lower);
  const double ready = now();
  X = Eigen::MatrixXd::Zero(B.rows(), B.cols());
  X.bottomRows(B.rows() - 1) = method.solve(B.bottomRows(B.rows() - 1));
  result.solve = now() - ready;
  result.peak_bytes = peak_bytes();
  result.set_up = ready - start;
  return result;
}

Result cholmod(int ordering, const Matrix& L, const Eigen::MatrixXd& B, Eigen::MatrixXd& X) {
  Eigen::CholmodSupernodalLLT<Matrix, Eigen::Lower> method;
  method.cholmod().nmethods = 1;
  method.cholmod().method[0].ordering = ordering;
  method.cholmod().postorder = 1;
  Result result = factorised(method, L, B, X);
  result.name = ordering == CHOLMOD_METIS ? "CHOLMOD, METIS ordering" : "CHOLMOD, AMD ordering";
  return result;
}

// Calls pass(i, sums) for every row on all cores; returns the total of what the threads summed up.
template <class Pass>
Eigen::RowVectorXd over_rows(Eigen::Index n, Eigen::Index width, const Pass& pass) {
  Eigen::RowVectorXd total = Eigen::RowVectorXd::Zero(width);
#pragma omp parallel
  {
    Eigen::RowVectorXd sums = Eigen::RowVectorXd::Zero(width);
#pragma omp for schedule(static)
    for (Eigen::Index i = 0; i < n; ++i) pass(i, sums);
#pragma omp critical
    total += sums;
  }
  return total;
}

Eigen::RowVectorXd quotient(const Eigen::RowVectorXd& a, const Eigen::RowVectorXd& b) {
  return (b.array() > 0).select(a.array() / b.array(), 0.0);
}

// Textbook conjugate gradients for all columns at once, three passes over the rows an iteration.
Result conjugate_gradients(bool jacobi, double tolerance, const Matrix& L, const Eigen::MatrixXd& B,
                           Eigen::MatrixXd& solution) {
  Result result;
  result.name = jacobi ? "conjugate gradients, diagonal preconditioner" : "conjugate gradients";
  const double start = now();
  const Rows A = L;
  const auto n = A.rows(), k = B.cols();
  const Eigen::VectorXd scale = jacobi ? A.diagonal().cwiseInverse().eval() : Eigen::VectorXd::Ones(n).eval();
  Block X = Block::Zero(n, k), R = B, P = scale.asDiagonal() * R, Q(n, k);
  const Eigen::RowVectorXd wanted = (tolerance * B.colwise().norm()).cwiseAbs2();
  Eigen::RowVectorXd rr = R.colwise().squaredNorm(), rz = (R.array() * P.array()).colwise().sum();
  while ((rr.array() > wanted.array()).any() && result.iterations < kMostIterations) {
    const Eigen::RowVectorXd pq = over_rows(n, k, [&](Eigen::Index i, Eigen::RowVectorXd& sums) {
      Q.row(i).setZero();
      for (Rows::InnerIterator entry(A, i); entry; ++entry) Q.row(i) += entry.value() * P.row(entry.col());
      sums.array() += P.row(i).array() * Q.row(i).array();
    });
    const Eigen::RowVectorXd alpha = quotient(rz, pq);
    const Eigen::RowVectorXd sums = over_rows(n, 2 * k, [&](Eigen::Index i, Eigen::RowVectorXd& s) {
      X.row(i).array() += alpha.array() * P.row(i).array();
      R.row(i).array() -= alpha.array() * Q.row(i).array();
      s.head(k).array() += scale[i] * R.row(i).array().square();
      s.tail(k).array() += R.row(i).array().square();
    });
    const Eigen::RowVectorXd beta = quotient(sums.head(k), rz);
    over_rows(n, 0, [&](Eigen::Index i, Eigen::RowVectorXd&) {
      P.row(i).array() = scale[i] * R.row(i).array() + beta.array() * P.row(i).array();
    });
    rz = sums.head(k);
    rr = sums.tail(k);
    ++result.iterations;
  }
  result.solve = now() - start;
  result.peak_bytes = peak_bytes();
  solution = X;
  return result;
}

template <class Scalar>
void put(std::ofstream& file, const Scalar* data, Eigen::Index count) {
  file.write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(sizeof(Scalar)) * count);
}

// Row count, number of entries and number of right-hand sides (int64), row starts, columns (int32), values, B.
void write_matrix(const std::string& path, const Matrix& L, const Eigen::MatrixXd& B) {
  std::ofstream file(path, std::ios::binary);
  const std::int64_t sizes[] = {L.rows(), L.nonZeros(), B.cols()};
  put(file, sizes, 3);
  put(file, L.outerIndexPtr(), L.rows() + 1);
  put(file, L.innerIndexPtr(), L.nonZeros());
  put(file, L.valuePtr(), L.nonZeros());
  put(file, B.data(), B.size());
}

Result other(const std::string& method, double tolerance, const Matrix& L, const Eigen::MatrixXd& B,
             Eigen::MatrixXd& X) {
  if (method == "cholmod-amd") return cholmod(CHOLMOD_AMD, L, B, X);
  if (method == "cholmod-metis") return cholmod(CHOLMOD_METIS, L, B, X);
  if (method == "cg" || method == "jacobi-cg") return conjugate_gradients(method != "cg", tolerance, L, B, X);
  Eigen::SimplicialLDLT<Matrix, Eigen::Lower> ldlt;
  Result result = factorised(ldlt, L, B, X);
  result.name = "Eigen SimplicialLDLT";
  return result;
}

void print(const Result& r, std::size_t faces, double before) {
  std::printf(
      "{\"name\": \"%s\", \"faces\": %zu, \"assembly\": %.4f, \"set_up\": %.4f, \"solve\": %.4f, \"iterations\": %d, "
      "\"residual\": %.2e, \"peak_bytes\": %.0f, \"bytes_before\": %.0f}\n",
      r.name.c_str(), faces, r.assembly, r.set_up, r.solve, r.iterations, r.residual, r.peak_bytes, before);
}

Result run(const mesh::Surface& surface, const std::string& method, int count, double tolerance) {
  Matrix L;
  Eigen::MatrixXd B, X;
  Result result;
  if (method == "multigrid" || method == "direct") {
    const auto own = method == "direct" ? solver::Method::direct : solver::Method::multigrid;
    result = library(surface, own, count, tolerance, L, B, X);
  } else {
    L = assembled(surface, false).matrix();
    B = right_hand_sides(L.rows(), count);
    result = other(method, tolerance, L, B, X);
  }
  result.residual = largest_residual(L, X, B);
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 5 || argc > 6) {
    std::fprintf(stderr, "usage: solvers MESH METHOD RHS TOLERANCE [RUNS]\n");
    return 2;
  }
  const std::string method = argv[2];
  const int count = std::stoi(argv[3]), runs = argc == 6 ? std::stoi(argv[5]) : 1;
  if (method.rfind("cholmod", 0) == 0) openblas_set_num_threads(static_cast<int>(std::thread::hardware_concurrency()));
  Execution silent;
  const auto surface = mesh::make_surface(mesh::read(argv[1]), silent);
  if (method.rfind("matrix=", 0) == 0) {
    const Matrix L = assembled(surface, false).matrix();
    write_matrix(method.substr(7), L, right_hand_sides(L.rows(), count));
    return 0;
  }
  const double before = peak_bytes();
  for (int i = 0; i < runs; ++i) {
    print(run(surface, method, count, std::stod(argv[4])), surface.triangles.size(), before);
    keep_memory();
  }
}
