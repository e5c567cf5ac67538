#include "choice/tiling_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "choice/any_structure.h"
#include "choice/automatic_structure.h"
#include "choice/turned_parts.h"

namespace holomorph::choice {
namespace {

constexpr double kMostStretched = 1.35, kTiles = 60;

// The tilings of a part with the poles that are asked for.
class Searched {
 public:
  Searched(PartPointer part, const TileOptions& options)
      : budget_(part->triangle_count(), 100),
        search_(part, automatic_structure(part, {}, execution_),
                {.part = part, .main = Main::kSeamless, .evenness = 0, .tiling = options}, budget_) {}

  MapPointer tiling() { return search_.of_density(kTiles / search_.part()->area, 1, execution_).front(); }
  MapPointer stretched(const MapPointer& made, double factor) {
    return search_.stretched(*made, factor * made->density(), execution_);
  }

 private:
  Execution execution_{1};
  Budget budget_;
  TilingSearch search_;
};

// The differences of the UVs at the corners of each vertex that is no pole to those at its first corner.
uv::UvArray jumps(const Map& made) {
  const std::vector<int>& vertices = made.part()->surface->polygons.corner_vertices;
  std::vector<Eigen::Index> first(static_cast<std::size_t>(made.part()->surface->vertex_count), -1);
  uv::UvArray result = uv::UvArray::Zero(made.uv().rows(), 2);
  for (Eigen::Index c = 0; c < made.uv().rows(); ++c) {
    const int v = vertices[static_cast<std::size_t>(c)];
    if (std::ranges::count(made.tiling()->poles, v) > 0) continue;
    Eigen::Index& known = first[static_cast<std::size_t>(v)];
    if (known < 0) known = c;
    result.row(c) = made.uv().row(c) - made.uv().row(known);
  }
  return result;
}

class Stretched : public testing::TestWithParam<std::pair<double, double>> {};

TEST_P(Stretched, ALimbShowsNoSeamAcrossItsJumps) {
  const auto [turn, factor] = GetParam();
  TileOptions options;
  options.poles.count = 2;
  options.turn = turn;
  options.max_turn = 0.05;
  Searched search(limb(), options);
  const MapPointer made = search.tiling(), found = search.stretched(made, factor);
  ASSERT_TRUE(found);
  EXPECT_EQ(std::ranges::any_of(made->tiling()->residues, [](const auto& r) { return r.imag() != 0; }), turn > 0);
  const uv::Quality &before = made->quality(), &after = found->quality();
  EXPECT_NEAR(after.median_density, factor * before.median_density, 1e-12 * after.median_density);
  EXPECT_NEAR(found->density(), factor * made->density(), 1e-4 * found->density());
  EXPECT_NEAR(found->tiling()->tiles, factor * made->tiling()->tiles, 1e-9 * found->tiling()->tiles);
  Execution execution(1);
  const uv::Quality own = uv::quality(*found->tiling()->triangulation, found->uv(), execution.workers());
  EXPECT_EQ(after.mean_angle, own.mean_angle);
  for (std::size_t t = 0; t < own.area.size(); ++t) EXPECT_NEAR(after.area[t], own.area[t], 1e-4 * own.area[t]);
  const uv::UvArray whole = jumps(*made);
  EXPECT_GT(whole.cwiseAbs().maxCoeff(), 0);
  EXPECT_EQ(whole, whole.array().round().matrix());
  EXPECT_EQ(whole, jumps(*found));
  EXPECT_NEAR(after.mean_angle, std::max(factor, 1 / factor), 0.2);
  EXPECT_EQ(after.flipped_part, 0);
}

INSTANTIATE_TEST_SUITE_P(TilingSearch, Stretched,
                         testing::Values(std::pair(0.0, 0.8), std::pair(0.0, 1 / kMostStretched), std::pair(0.0, 1.3),
                                         std::pair(0.3, 0.8), std::pair(0.3, 1 / kMostStretched), std::pair(0.3, 1.3)));

TEST(TilingSearch, StretchesNothingTooFarAndNothingThatJumpsBothWays) {
  TileOptions two;
  two.poles.count = 2;
  Searched of_limb(limb(), two);
  const MapPointer made = of_limb.tiling();
  EXPECT_FALSE(of_limb.stretched(made, 1.01 * kMostStretched));
  EXPECT_FALSE(of_limb.stretched(made, 0.99 / kMostStretched));
  EXPECT_TRUE(of_limb.stretched(made, 0.99 * kMostStretched));
  TileOptions none;
  none.poles.count = 0;
  Searched of_torus(torus(16, 8), none);
  EXPECT_FALSE(of_torus.stretched(of_torus.tiling(), 1));
}

// A ball with bumps, of few triangles.
PartPointer blob(int seed) {
  constexpr int kRings = 9, kRound = 14;
  std::vector<Ring> rings;
  for (int k = 0; k <= kRings; ++k) {
    const double angle = std::numbers::pi * k / kRings;
    rings.push_back({k == 0 || k == kRings ? 0 : std::sin(angle), -std::cos(angle)});
  }
  const double s = 1.7 * seed;
  return turned_part(rings, kRound, false, {}, [s](const std::array<double, 3>& p) {
    return 1 + 0.3 * std::sin(3 * p[0] + 2 * p[1] + s) + 0.25 * std::sin(4 * p[2] - 3 * p[0] + 2 * s);
  });
}

class Bumpy : public testing::TestWithParam<int> {};

TEST_P(Bumpy, MorePolesAreTriedWhereTheMapIsLessEvenThanForetold) {
  constexpr double kUneven = 1.73;
  const PartPointer part = blob(GetParam());
  std::vector<std::string> stages;
  Execution execution(1, [&](double, const std::string& stage) {
    stages.push_back(stage);
    return true;
  });
  const StructurePointer structure = automatic_structure(part, {}, execution);
  Budget budget(part->triangle_count(), 1e6);
  TileOptions options;
  options.tiles = kTiles;
  options.evenness = 0.5;
  const SeamlessPointer plain = structure->tilers().tile(options, execution);
  const Map first(part, structure, plain, execution);
  const auto found = [&](double evenness) {
    Request request;
    request.part = part;
    request.main = Main::kSeamless;
    request.evenness = evenness;
    TilingSearch search(part, structure, request, budget);
    return search.of_density(kTiles / part->area, 1, execution).front();
  };
  const MapPointer made = found(0.5);
  if (first.drawn_range() <= kUneven) {
    EXPECT_EQ(made->uv(), first.uv());
  } else {
    EXPECT_LE(made->cost(), first.cost());
  }
  stages.clear();
  EXPECT_EQ(found(1)->tiling()->evenness, 1);
  // The first poles are kept; how many more there are follows from those that rounding leaves, so from the evenness.
  EXPECT_LE(std::ranges::count(stages, "search for poles"), 1);
}

INSTANTIATE_TEST_SUITE_P(TilingSearch, Bumpy, testing::Range(0, 8));

}  // namespace
}  // namespace holomorph::choice
