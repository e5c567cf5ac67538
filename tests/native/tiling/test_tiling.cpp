// The Abel-Jacobi map against the forms it foretells, walks, and measures of evenness.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>

#include "mesh/make_surface.h"
#include "mesh/stars.h"
#include "mesh/triangle_tree.h"
#include "structure/pole_structure.h"
#include "tiling/cones/cones.h"
#include "tiling/greens/pole_basis.h"
#include "tiling/inversion/abel_jacobi.h"
#include "tiling/maps/assemble.h"
#include "tiling/poles/meromorphic_form.h"
#include "tiling/poles/search_steps.h"
#include "tiling/rounding/rounding.h"

namespace holomorph::tiling {
namespace {

using Complex = std::complex<double>;

// A wavy torus of n x m quads, cut into triangles; without its first `missing` triangles.
std::shared_ptr<const mesh::Surface> wavy_torus(int n, int m, int missing = 0) {
  mesh::Polygons polygons;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < m; ++j) {
      const double a = 2 * std::numbers::pi * (i + 0.2 * std::sin(3.0 * i + j)) / n;
      const double b = 2 * std::numbers::pi * (j + 0.2 * std::cos(2.0 * j + i)) / m, ring = 2 + std::cos(b);
      polygons.vertices.push_back({ring * std::cos(a), ring * std::sin(a), (1 + 0.3 * std::sin(2 * a)) * std::sin(b)});
    }
  }
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < m; ++j) {
      const int a = i * m + j, b = (i + 1) % n * m + j, c = (i + 1) % n * m + (j + 1) % m, d = i * m + (j + 1) % m;
      for (const int v : {a, b, c, a, c, d}) polygons.corner_vertices.push_back(v);
    }
  }
  polygons.corner_vertices.erase(polygons.corner_vertices.begin(), polygons.corner_vertices.begin() + 3 * missing);
  for (std::size_t c = 0; c <= polygons.corner_vertices.size(); c += 3)
    polygons.face_offsets.push_back(static_cast<int>(c));
  Execution execution(1);
  return std::make_shared<mesh::Surface>(mesh::make_surface(std::move(polygons), execution));
}

TEST(GreensFunctions, AreKeptAndHaveDifferencesForAClosedSurface) {
  Execution execution(1);
  const auto basis = std::make_shared<const PoleBasis>(wavy_torus(30, 20), structure::Options{}, execution);
  GreensFunctions greens(basis), others(basis);
  greens.solve_at({5, 300}, execution);
  const Eigen::MatrixXcd before = greens.at({300, 5});
  greens.solve_at({300, 470, 5}, execution);
  EXPECT_EQ(greens.at({300, 5}), before);
  EXPECT_THROW(greens.at({7}), std::out_of_range);
  others.solve_at({470}, execution);
  EXPECT_LT((others.at({470}) - greens.at({470})).norm(), 1e-9 * before.norm());
  const Eigen::MatrixXcd all = greens.at({5, 300, 470}, 3), forms = greens.pole_forms({5, 300, 470}, 3);
  EXPECT_EQ(all.rows(), (static_cast<Eigen::Index>(basis->samples().size()) + 2) / 3);
  ASSERT_EQ(forms.cols(), 2);
  for (int i = 0; i < 2; ++i) EXPECT_EQ(forms.col(i), all.col(i) - all.col(2));
}

TEST(CandidateScores, AreNearTheVarianceOfTheLogarithm) {
  Execution execution(1);
  GreensFunctions greens(std::make_shared<const PoleBasis>(wavy_torus(30, 20), structure::Options{}, execution));
  const std::vector<int> vertices = {5, 300, 470};
  greens.solve_at(vertices, execution);
  for (const double scale : {1e-20, 1.0, 1e20}) {  // single precision is relative to the rest
    const Eigen::VectorXcd rest = scale * greens.basis().holomorphic().M.col(0)(Eigen::seq(0, Eigen::last, 3));
    CandidateScores scores(greens, 3);
    scores.prepare(vertices);
    scores.set_rest(rest, median(rest.cwiseAbs2().array()));
    for (const int v : vertices) {
      const std::complex<double> residue = std::polar(3.0 * scale, 0.7 * v);
      const double exact = unevenness((rest + residue * greens.at({v}, 3).col(0)).cwiseAbs2().array());
      EXPECT_NEAR(scores(v, residue), exact, 2e-3 * exact) << v;
    }
  }
}

TEST(AbelJacobi, ForetellsTheHarmonicPartOfEveryPole) {
  Execution execution(1);
  const auto surface = wavy_torus(30, 20);
  const PoleBasis basis(surface, {}, execution);
  const AbelJacobi map(basis, execution);
  for (const auto& [p, q] : {std::pair{5, 300}, {47, 411}, {220, 590}}) {
    const auto s = structure::pole_structure(surface, {{p, q}, {1.0, -1.0}, {}}, {}, execution);
    const Eigen::MatrixXd N = change_of_basis(basis.structure().topology.classes, s);
    EXPECT_NEAR(std::abs(N.determinant()), 1, 1e-12);
    const Eigen::VectorXd foretold = N * (map.at(p) - map.at(q)), found = s.poles->harmonic_part.col(0);
    EXPECT_LT((found - nearest_representative(foretold, found)).cwiseAbs().maxCoeff(), 1e-10);
  }
}

TEST(AbelJacobi, FollowsItsDerivative) {
  Execution execution(1);
  const auto surface = wavy_torus(60, 40);
  const PoleBasis basis(surface, {}, execution);
  const AbelJacobi map(basis, execution);
  const Jacobian jacobian(basis);
  const int from = 1000;
  const auto& half_edges = basis.half_edges();
  const mesh::HalfedgeHandle h = half_edges.halfedge_handle(mesh::VertexHandle(from));
  const int triangle = mesh::face_of(half_edges, h), to = mesh::to_vertex(half_edges, h);
  const mesh::SurfacePoint a = mesh::at_vertex(*surface, triangle, from), b = mesh::at_vertex(*surface, triangle, to);
  const Eigen::VectorXd step = -(jacobian.abel_jacobi_derivatives({triangle}).col(0) * (b.z - a.z)).real();
  const Eigen::VectorXd start = map.at(from), exact = nearest_representative(map.at(to), start) - start;
  EXPECT_LT((exact - step).norm(), 0.1 * step.norm());
}

// In any direction: the steps of Newton's method go there.
TEST(Jacobian, FollowsThePole) {
  Execution execution(1);
  const PoleBasis basis(wavy_torus(60, 40), {}, execution);
  const Jacobian jacobian(basis);
  const auto split = jacobian.split().bottomRows(basis.form_count());
  for (const int triangle : {0, 1000, 3000}) {
    const Complex tau = jacobian.tau({triangle})(0, 0);
    for (int i = 0; i < 8; ++i) {
      const Complex dz = std::polar(1.0, 0.8 * i);
      const Eigen::VectorXd lost = (jacobian.abel_jacobi_derivatives({triangle}).col(0) * dz).real();
      const Complex t = -(split * lost.cast<Complex>())[0];
      EXPECT_LT(std::abs(t - tau * dz), 0.1 * std::abs(tau));
    }
  }
}

TEST(Spread, SeesSmallParts) {
  Eigen::ArrayXd density = Eigen::ArrayXd::Ones(1000);
  density.head(20) = 0.01;  // toes: 2 % of the area
  EXPECT_DOUBLE_EQ(density_ratio(density), 1);
  EXPECT_DOUBLE_EQ(spread(density), 50);
  density.head(200) = 0.01;
  EXPECT_DOUBLE_EQ(spread(density), 100);
}

TEST(SeamlessMaps, OneFormIsTheCombinationOfTheBasis) {
  Execution execution(1);
  const auto surface = wavy_torus(30, 20);
  const std::vector<int> vertices{5, 300, 470};
  const auto basis = std::make_shared<const PoleBasis>(surface, structure::Options{}, execution);
  const SeamlessMaps maps(basis, false, vertices, {}, {}, execution);
  const auto s = structure::pole_structure(surface, {vertices, {1.0, 1.0, -2.0}, {}}, {}, execution);
  const AbelJacobi map(*basis, execution);
  const Eigen::VectorXcd r{{Complex(2, -1), Complex(1, 3), Complex(-3, -2)}};
  Eigen::VectorXcd X = r[0] * (map.at(5) - map.at(470)) + r[1] * (map.at(300) - map.at(470));
  X += Eigen::VectorXcd{{Complex(4, -7), Complex(-3, 2)}};
  const SeamlessForm form = maps.form(X, r, {});
  for (const Complex period : form.periods) EXPECT_LT(std::abs(period - TextureLattice{}.nearest(period)), 1e-12);
  Eigen::MatrixXd difference = maps.function(form, execution) - function_of(s, form, execution);
  difference.rowwise() -= Eigen::RowVectorXd(difference.row(0));
  EXPECT_LT(difference.cwiseAbs().maxCoeff(), 1e-8);
}

TEST(SurfaceWalk, ComesBack) {
  const auto surface = wavy_torus(30, 20);
  Execution execution(1);
  const mesh::HalfEdges half_edges = mesh::half_edges(*surface, execution);
  const mesh::Sides sides(*surface);
  const mesh::SurfacePoint start = mesh::at_vertex(*surface, 100, surface->triangles[100][1]);
  for (int i = 0; i < 12; ++i) {
    mesh::SurfacePoint point = start;
    const Complex dz = std::polar(0.8, 0.5 * i);
    const mesh::WalkSteps steps = mesh::walk(*surface, half_edges, sides, point, dz);
    ASSERT_GT(steps.size(), 1u);
    double length = 0;
    for (const auto& [triangle, part] : steps) length += std::abs(part);
    EXPECT_NEAR(length, 0.8, 1e-12);
    const Complex last = steps.back().second;
    mesh::walk(*surface, half_edges, sides, point, -0.8 * last / std::abs(last));
    EXPECT_EQ(point.triangle, start.triangle);
    EXPECT_LT(std::abs(point.z - start.z), 1e-9);
  }
}

TEST(AmbientOcclusion, IsAllOutsideAndLessInsideOfARing) {
  const auto surface = wavy_torus(60, 40);
  std::vector<int> vertices;
  for (int v = 0; v < surface->vertex_count; v += 7) vertices.push_back(v);
  Execution one(1), two(2);
  mesh::AmbientOcclusion exposure(*surface), other(*surface);
  exposure.prepare(vertices, one.workers());
  other.prepare(vertices, two.workers());
  double inside = 0, outside = 1;
  for (const int v : vertices) {
    EXPECT_EQ(exposure(v), other(v));
    EXPECT_GE(exposure(v), 0);
    EXPECT_LE(exposure(v), 1);
    const auto& p = surface->polygons.vertices[v];
    const double ring = std::hypot(p[0], p[1]);
    if (ring > 2.9) outside = std::min(outside, exposure(v));
    if (ring < 1.1) inside = std::max(inside, exposure(v));
  }
  EXPECT_GT(outside, 0.98);
  EXPECT_LT(inside, 0.9);
}

TEST(SurfaceWalk, EndsAtTheBoundary) {
  const auto surface = wavy_torus(12, 8, 60);
  Execution execution(1);
  const mesh::HalfEdges half_edges = mesh::half_edges(*surface, execution);
  const mesh::Sides sides(*surface);
  for (int i = 0; i < 12; ++i) {
    mesh::SurfacePoint point = mesh::at_vertex(*surface, 100, surface->triangles[100][0]);
    mesh::walk(*surface, half_edges, sides, point, std::polar(100.0, 0.5 * i));
    EXPECT_TRUE(std::isfinite(std::abs(point.z)));
  }
}

TEST(TextureLattice, NearestPointsAndSymmetry) {
  const TextureLattice square, hexagonal{1.0, std::polar(1.0, std::numbers::pi / 3)}, brick{1.0, {0.5, 1.0}};
  EXPECT_NEAR(square.symmetry(), std::numbers::pi / 2, 1e-12);
  EXPECT_NEAR(hexagonal.symmetry(), std::numbers::pi / 3, 1e-12);
  EXPECT_NEAR(brick.symmetry(), std::numbers::pi, 1e-12);
  for (const auto& lattice : {square, hexagonal, brick}) {
    const Complex point = lattice.point(3, -2);
    EXPECT_LT(std::abs(lattice.nearest(point + Complex(0.2, -0.1)) - point), 1e-12);
    EXPECT_LT((lattice.coordinates(point) - Eigen::Vector2d(3, -2)).norm(), 1e-12);
  }
}

// The mean height of the cones that cost least where `up` is up.
double height_of_cones(const mesh::Surface& surface, double price, double up) {
  Execution execution(1);
  const ConeOptions options{.k = 4, .price = price, .along = Along{{0, 0, up}}};
  const std::vector<Cones> found = find_cones(surface, options, execution);
  const Cones& best = *std::ranges::min_element(found, {}, [](const Cones& each) { return each.u2 + each.price; });
  double sum = 0, count = 0;
  for (int v = 0; v < surface.vertex_count; ++v) {
    if (best.missing[v] == 0) continue;
    sum += surface.polygons.vertices[v][2];
    ++count;
  }
  return sum / count;
}

TEST(Cones, LieWhereTheyAreSeenLeast) {
  const auto torus = wavy_torus(24, 16);
  for (const double price : {0.001, 0.01}) {
    EXPECT_LT(height_of_cones(*torus, price, 1), -0.1);
    EXPECT_GT(height_of_cones(*torus, price, -1), 0.1);
  }
}

}  // namespace
}  // namespace holomorph::tiling
