#include "laplacians.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cstring>
#include <map>
#include <random>

namespace holomorph::solver {
namespace {

// In [0, 1): the library's distributions differ between compilers.
double next_number(std::mt19937& engine) { return static_cast<double>(engine()) / 4294967296.0; }

std::vector<int> others_of(int size, const std::vector<int>& fixed) {
  std::vector<char> is_fixed(size, 0);
  for (const int v : fixed) is_fixed[v] = 1;
  std::vector<int> others;
  for (int v = 0; v < size; ++v) {
    if (is_fixed[v] == 0) others.push_back(v);
  }
  return others;
}

}  // namespace

Laplacian grid_laplacian(int width, int height, Shape shape, unsigned seed) {
  std::mt19937 engine(seed);
  std::vector<std::map<int, double>> rows(static_cast<std::size_t>(width) * height);
  const auto add_edge = [&](int x, int y, int dx, int dy) {
    if (shape == Shape::sheet && (x + dx == width || y + dy == height)) return;
    const int a = y * width + x, b = (y + dy) % height * width + (x + dx) % width;
    const double weight = 0.1 + 1.9 * next_number(engine);
    rows[a][b] -= weight;
    rows[b][a] -= weight;
    rows[a][a] += weight;
    rows[b][b] += weight;
  };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      add_edge(x, y, 1, 0);
      add_edge(x, y, 0, 1);
      add_edge(x, y, 1, 1);
    }
  }
  Laplacian L;
  L.starts.push_back(0);
  for (const auto& row : rows) {
    for (const auto& [column, weight] : row) {
      L.columns.push_back(column);
      L.weights.push_back(weight);
    }
    L.starts.push_back(static_cast<int>(L.columns.size()));
  }
  return L;
}

Eigen::MatrixXd random_values(Eigen::Index rows, Eigen::Index columns, unsigned seed) {
  std::mt19937 engine(seed);
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return 2 * next_number(engine) - 1; });
}

Eigen::MatrixXd centred(const Eigen::MatrixXd& X) { return X.rowwise() - X.colwise().mean(); }

double relative_residual(const Laplacian& L, const Eigen::MatrixXd& X, const Eigen::MatrixXd& B,
                         const std::vector<int>& fixed) {
  const std::vector<int> others = others_of(L.size(), fixed);
  const Eigen::MatrixXd R = (B - L.matrix() * X)(others, Eigen::all), right = B(others, Eigen::all);
  return (R.colwise().norm().array() / right.colwise().norm().array()).maxCoeff();
}

DenseSolution dense_solution(const Laplacian& L, const Eigen::MatrixXd& B, const std::vector<int>& fixed) {
  const std::vector<int> others = others_of(L.size(), fixed);
  const Eigen::MatrixXd A = Eigen::MatrixXd(L.matrix())(others, others);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(A);
  Eigen::VectorXd inverse = eigen.eigenvalues().cwiseInverse();
  if (fixed.empty()) inverse[0] = 0;  // the constants
  DenseSolution result{Eigen::MatrixXd::Zero(B.rows(), B.cols()), eigen.eigenvalues()[fixed.empty() ? 1 : 0]};
  result.X(others, Eigen::all) =
      eigen.eigenvectors() * (inverse.asDiagonal() * (eigen.eigenvectors().transpose() * B(others, Eigen::all)));
  return result;
}

Eigen::MatrixXd positive_solution(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B, const std::vector<int>& fixed) {
  const std::vector<int> others = others_of(static_cast<int>(A.rows()), fixed);
  Eigen::MatrixXd X = Eigen::MatrixXd::Zero(B.rows(), B.cols());
  if (others.empty()) return X;
  const Eigen::MatrixXd part = A(others, others), right = B(others, Eigen::all);
  const Eigen::MatrixXd solution = part.llt().solve(right);
  X(others, Eigen::all) = solution;
  return X;
}

bool same_bits(const Eigen::MatrixXd& X, const Eigen::MatrixXd& Y) {
  return X.rows() == Y.rows() && X.cols() == Y.cols() &&
         std::memcmp(X.data(), Y.data(), static_cast<std::size_t>(X.size()) * sizeof(double)) == 0;
}

}  // namespace holomorph::solver
