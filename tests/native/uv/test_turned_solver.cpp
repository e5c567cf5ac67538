// The Laplacian of functions that turn by quarters, on a graph with their parts for vertices.
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

TEST_F(TurnedSolverTest, TheLaplacianOfTheCoverIsThatOfTheConnection) {
  const auto cover = Cover::of(surface_, kept_);
  ASSERT_TRUE(cover);
  const solver::Laplacian L = cover->laplacian(weights_);
  const int count = kept_.unknowns.count;
  const Eigen::VectorXd x = Eigen::VectorXd::Random(count);
  Eigen::VectorXd lifted = Eigen::VectorXd::Zero(L.size());
  for (int i = 0; i < count; ++i) lifted[2 * i] = x[i], lifted[2 * i + 1] = -x[i];
  // The energy, edge by edge, once each: twice it is that of both signs.
  const Function f = kept_.unknowns.spread(x);
  double energy = 0;
  std::vector<char> done(surface_.edges.size(), 0);
  for (std::size_t t = 0; t < surface_.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const int edge = surface_.triangle_edges[t][i], j = (i + 1) % 3;
      if (done[edge]) continue;
      done[edge] = 1;
      const Complex a = kept_.turns[t][i] * f[surface_.triangles[t][i]];
      const Complex b = kept_.turns[t][j] * f[surface_.triangles[t][j]];
      energy += weights_[edge] * std::norm(a - b);
    }
  }
  const Eigen::VectorXd Lx = L.matrix() * lifted;
  EXPECT_NEAR(lifted.dot(Lx), 2 * energy, 1e-12 * energy);
  for (int i = 0; i < count; ++i) EXPECT_EQ(Lx[2 * i], -Lx[2 * i + 1]);
  EXPECT_NEAR((L.matrix() * Eigen::VectorXd::Ones(L.size())).cwiseAbs().maxCoeff(), 0, 1e-12);
}

TEST_F(TurnedSolverTest, ACycleIsAnApproximateInverse) {
  Execution execution(1);
  TurnedSolver direct(surface_, kept_, "direct"), cycle(surface_, kept_, "multigrid");
  direct.make(weights_, execution);
  cycle.make(weights_, execution);
  const Function b = random_function(), c = random_function();
  const Function exact = direct.precondition(b, execution), rough = cycle.precondition(b, execution);
  Function difference = rough;
  for (std::size_t v = 0; v < b.size(); ++v) difference[v] -= exact[v];
  EXPECT_GT(product(difference, difference), 0);  // it is not the same solver
  EXPECT_LT(product(difference, difference), 0.04 * product(exact, exact));
  const Function other = cycle.precondition(c, execution);
  EXPECT_NEAR(product(c, rough), product(b, other), 1e-5 * std::abs(product(b, rough)));  // in single precision
}

TEST_F(TurnedSolverTest, OtherTurnsAndLooseUnknownsHaveNoCover) {
  Kept sixths = kept_;
  sixths.turns[5][1] = std::polar(1.0, std::numbers::pi / 3);
  EXPECT_FALSE(Cover::of(surface_, sixths));
  Kept loose = kept_;
  for (auto& corners : loose.turns) corners = {1, 1, 1};
  loose.unknowns.number[1] = loose.unknowns.count++;  // no v is held, and nothing turns u to v
  loose.unknowns.number[100] = loose.unknowns.count++;
  EXPECT_FALSE(Cover::of(surface_, loose));
}

}  // namespace
}  // namespace holomorph::uv
