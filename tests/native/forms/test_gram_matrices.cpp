#include "forms/gram_matrices.h"

#include <gtest/gtest.h>

#include "mesh/intrinsic_surface.h"

namespace holomorph::forms {
namespace {

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

}  // namespace
}  // namespace holomorph::forms
