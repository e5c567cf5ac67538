// The Laplacian of functions that turn by quarters, and its inverses.
#include "uv/turned_functions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "mesh/make_surface.h"

namespace holomorph::uv {
namespace {

// A grid of squares around a torus.
mesh::Surface torus(int n, int m) {
  mesh::Polygons polygons;
  polygons.face_offsets.push_back(0);
  for (int j = 0; j < m; ++j) {
    for (int i = 0; i < n; ++i) {
      const double a = 2 * std::numbers::pi * i / n, b = 2 * std::numbers::pi * j / m, r = 2 + std::cos(b);
      polygons.vertices.push_back({r * std::cos(a), r * std::sin(a), std::sin(b)});
      const int next = (i + 1) % n, up = (j + 1) % m;
      for (const int v : {j * n + i, j * n + next, up * n + next, up * n + i}) polygons.corner_vertices.push_back(v);
      polygons.face_offsets.push_back(static_cast<int>(polygons.corner_vertices.size()));
    }
  }
  Execution execution(1);
  return mesh::make_surface(std::move(polygons), execution);
}

class TurnedSolverTest : public ::testing::Test {
 protected:
  TurnedSolverTest() : surface_(torus(40, 24)), weights_(surface_.edges.size()) {
    // Any turns will do, signs, parts that are 0, and parts that are one unknown.
    const Complex turns[] = {1, Complex(0, 1), -1, Complex(0, -1)};
    kept_.turns.resize(surface_.triangles.size());
    for (auto& corners : kept_.turns) {
      for (Complex& turn : corners) turn = turns[random_() % 4];
    }
    Unknowns& unknowns = kept_.unknowns;
    for (int part = 0; part < 2 * surface_.vertex_count; ++part) {
      const bool is_held = part < 2, is_shared = part == 100;
      unknowns.number.push_back(is_held ? -1 : is_shared ? unknowns.number[51] : unknowns.count++);
      unknowns.sign.push_back(random_() % 2 == 0 ? 1 : -1);
    }
    for (double& weight : weights_) weight = 0.1 + static_cast<double>(random_() % 1000) / 300;
  }

  Function random_function() {
    Function function(surface_.vertex_count);
    const auto part = [&] { return static_cast<double>(random_() % 2001) / 1000 - 1; };
    for (Complex& value : function) value = {part(), part()};
    return kept_.unknowns.spread(kept_.unknowns.gathered(function));
  }

  std::mt19937 random_{7};
  mesh::Surface surface_;
  Kept kept_;
  Array<double> weights_;
};

double product(const Function& a, const Function& b) {
  double sum = 0;
  for (std::size_t v = 0; v < a.size(); ++v) sum += a[v].real() * b[v].real() + a[v].imag() * b[v].imag();
  return sum;
}

TEST_F(TurnedSolverTest, TheFactorInvertsTheLaplacianOfTheConnection) {
  TurnedSolver solver(surface_, kept_, false);
  solver.make(weights_);
  const Function b = random_function(), x = solver.precondition(b);
  // The energy, edge by edge, once each.
  double energy = 0;
  std::vector<char> done(surface_.edges.size(), 0);
  for (std::size_t t = 0; t < surface_.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const int edge = surface_.triangle_edges[t][i], j = (i + 1) % 3;
      if (done[edge]) continue;
      done[edge] = 1;
      const Complex p = kept_.turns[t][i] * x[surface_.triangles[t][i]];
      const Complex q = kept_.turns[t][j] * x[surface_.triangles[t][j]];
      energy += weights_[edge] * std::norm(p - q);
    }
  }
  // x L x = kInverse x g, where g sums what b has at the parts of an unknown.
  const Eigen::VectorXd g = kept_.unknowns.gathered(b);
  Eigen::VectorXd unknown = Eigen::VectorXd::Zero(g.size());
  for (std::size_t part = 0; part < kept_.unknowns.number.size(); ++part) {
    const int i = kept_.unknowns.number[part];
    if (i >= 0) unknown[i] = kept_.unknowns.sign[part] * (part % 2 == 0 ? x[part / 2].real() : x[part / 2].imag());
  }
  EXPECT_GT(energy, 0);
  EXPECT_NEAR(energy, kInverse * unknown.dot(g), 1e-9 * energy);
}

TEST_F(TurnedSolverTest, TheDiagonalIsSymmetricAndSeesNoNeighbour) {
  TurnedSolver solver(surface_, kept_, true);
  solver.make(weights_);
  const Function b = random_function(), c = random_function(), x = solver.precondition(b), y = solver.precondition(c);
  EXPECT_NEAR(product(c, x), product(b, y), 1e-9 * std::abs(product(b, x)));
  Function one(surface_.vertex_count, 0.0);
  one[30] = 1;
  const Function at = solver.precondition(one);
  double sum = 0;
  for (std::size_t e = 0; e < surface_.edges.size(); ++e) {
    if (surface_.edges[e][0] == 30 || surface_.edges[e][1] == 30) sum += weights_[e];
  }
  EXPECT_NEAR(at[30].real(), kInverse / sum, 1e-12);
  EXPECT_NEAR(product(at, at), at[30].real() * at[30].real(), 1e-15);
}

}  // namespace
}  // namespace holomorph::uv
