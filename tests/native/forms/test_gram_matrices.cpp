#include "forms/gram_matrices.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>
#include <numeric>
#include <random>

#include "mesh/intrinsic_surface.h"

namespace holomorph::forms {
namespace {

using Wide = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

// Two triangles glued to a torus of one vertex, two forms with integer values on its edges and no functions.
class GramMatrices : public testing::TestWithParam<std::vector<int>> {
 protected:
  GramMatrices() {
    for (int e = 0; e < 3; ++e) classes.rows.set(e, {{0, e + 1}, {1, 1 - e}});
  }

  Execution execution{1};
  mesh::Surface surface = mesh::make_intrinsic_surface(1, {{0, 0, 0}, {0, 0, 0}}, {{3, 4, 5}, {3, 4, 5}},
                                                       {{0, 1, 2}, {0, 1, 2}}, execution);
  mesh::HalfEdges half_edges = mesh::half_edges(surface, execution);
  topology::IntegerForms classes = [] {
    topology::IntegerForms forms;
    forms.form_count = 2;
    forms.rows.resize(3);
    return forms;
  }();
  RowMajorMatrix functions = RowMajorMatrix::Zero(1, 2);
};

TEST_P(GramMatrices, AWeightOf0HasAnError) {
  const std::vector<double> weights = {0, 0, 0}, errors = {1, 2, 4};
  const auto measured = gram_matrices(half_edges, weights, errors, {classes, functions}, GetParam(), execution);
  double first = 0, size = 0;
  for (int e = 0; e < 3; ++e) {
    first += errors[e] * (e + 1) * (e + 1);
    size += errors[e] * (1 - e) * (1 - e);
  }
  EXPECT_EQ(measured.front().uncertain(0, 0), first);
  EXPECT_EQ(measured.front().size[0], first);
  EXPECT_EQ(measured.back().uncertain.diagonal().tail<1>().value(), size);
  EXPECT_EQ(measured.back().size.tail<1>().value(), size);
  EXPECT_TRUE(measured.front().value.isZero());
}

INSTANTIATE_TEST_SUITE_P(Families, GramMatrices, testing::Values(std::vector<int>{2}, std::vector<int>{1, 1}));

// A torus of n x n squares with many forms d f, weights of both signs and errors of many sizes.
class ManyForms : public testing::TestWithParam<std::vector<int>> {
 protected:
  static constexpr int kSide = 36;

  ManyForms() {
    classes.form_count = count;
    classes.rows.resize(half_edges.n_edges());
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    functions = RowMajorMatrix::NullaryExpr(kSide * kSide, count, [&] { return normal(random); });
    for (std::size_t e = 0; e < half_edges.n_edges(); ++e) {
      weights.push_back(std::max(normal(random) + 1.5, -0.1));
      errors.push_back(1e-9 * std::exp(normal(random)));
      if (e % 50 == 0) weights[e] = 0;
      if (e % 70 == 0) errors[e] = 1e-6;
    }
  }

  mesh::Surface torus() {
    std::vector<std::array<std::int64_t, 3>> triangles, edges;
    std::vector<std::array<double, 3>> lengths;
    for (int i = 0; i < kSide; ++i) {
      for (int j = 0; j < kSide; ++j) {
        const int v = i * kSide + j, right = i * kSide + (j + 1) % kSide, up = (i + 1) % kSide * kSide + j,
                  across = (i + 1) % kSide * kSide + (j + 1) % kSide;
        triangles.push_back({v, right, across});
        edges.push_back({3 * right + 1, 3 * v + 2, 3 * v});
        lengths.push_back({1, std::sqrt(2), 1});
        triangles.push_back({v, across, up});
        edges.push_back({3 * up, 3 * v + 1, 3 * v + 2});
        lengths.push_back({1, 1, std::sqrt(2)});
      }
    }
    return mesh::make_intrinsic_surface(kSide * kSide, triangles, lengths, edges, execution);
  }

  // The largest energies that weights within their errors give, in extended precision.
  Wide exact(int first, int size) const {
    Wide sum = Wide::Zero(size, size);
    for (int e = 0; e < static_cast<int>(weights.size()); ++e) {
      const mesh::HalfedgeHandle h(2 * e);
      const Wide f = functions.cast<long double>().middleCols(first, size);
      const Wide value = f.row(mesh::to_vertex(half_edges, h)) - f.row(mesh::from_vertex(half_edges, h));
      sum += (static_cast<long double>(weights[e]) + errors[e]) * (value.transpose() * value);
    }
    return sum;
  }

  int count = std::accumulate(GetParam().begin(), GetParam().end(), 0);
  Execution execution{1};
  mesh::Surface surface = torus();
  mesh::HalfEdges half_edges = mesh::half_edges(surface, execution);
  topology::IntegerForms classes;
  RowMajorMatrix functions;
  std::vector<double> weights, errors;
};

TEST_P(ManyForms, BoundsAreAboveAllThatWeightsWithinTheirErrorsGive) {
  const auto measured = gram_matrices(half_edges, weights, errors, {classes, functions}, GetParam(), execution);
  int first = 0;
  for (std::size_t i = 0; i < measured.size(); first += GetParam()[i++]) {
    const Wide most = exact(first, GetParam()[i]), E = gram_errors(measured[i]).cast<long double>(),
               gap = measured[i].value.cast<long double>() + E - most;
    const Eigen::SelfAdjointEigenSolver<Wide> eigen(gap, Eigen::EigenvaluesOnly);
    EXPECT_GT(eigen.eigenvalues().minCoeff(), 0);
    EXPECT_LT(E.norm(), 1e-6 * most.norm());
    EXPECT_TRUE(measured[i].value.isApprox(measured[i].value.transpose(), 0));
  }
}

TEST_P(ManyForms, ThreadsDoNotChangeABit) {
  const ClosedForms forms{classes, functions};
  const auto one = gram_matrices(half_edges, weights, errors, forms, GetParam(), execution);
  Execution others{3};
  const auto three = gram_matrices(half_edges, weights, errors, forms, GetParam(), others);
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].value, three[i].value);
    EXPECT_EQ(one[i].uncertain, three[i].uncertain);
    EXPECT_EQ(one[i].size, three[i].size);
  }
}

INSTANTIATE_TEST_SUITE_P(Families, ManyForms, testing::Values(std::vector<int>{40}, std::vector<int>{70, 33}));

}  // namespace
}  // namespace holomorph::forms
