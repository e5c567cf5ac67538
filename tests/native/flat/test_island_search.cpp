#include "flat/island_search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "choice/turned_parts.h"

namespace holomorph::flat {
namespace {

constexpr double kDeep = 1.9, kEvenness = 0.5;

// A cap of a sphere of so deep, whose map stretches: it is cut to its tip.
choice::PartPointer dome() {
  constexpr int kRings = 24, kRound = 24;
  std::vector<choice::Ring> rings;
  for (int k = kRings; k >= 0; --k) {
    const double angle = std::acos(1 - kDeep) * k / kRings;
    rings.push_back({k == 0 ? 0 : std::sin(angle), std::cos(angle)});
  }
  return choice::turned_part(rings, kRound);
}

class IslandsOfADome : public testing::Test {
 protected:
  IslandSearch search() { return {*part_->surface, {kEvenness, uv::Up::kZ, true}, execution_}; }
  // Operations.
  template <class Work>
  static std::uint64_t counted(const Work& work) {
    const std::uint64_t before = Execution::work();
    work();
    return Execution::work() - before;
  }

  choice::PartPointer part_ = dome();
  Execution execution_{1};
};

TEST_F(IslandsOfADome, AreLookedForAsFarAsTheyMayBeWorthIt) {
  std::shared_ptr<const Layout> wanted;
  const std::uint64_t most = counted([&] { wanted = island_map(*part_->surface, {kEvenness}, execution_); });
  ASSERT_TRUE(wanted);
  EXPECT_GT(wanted->seams.size(), 0u);
  EXPECT_FALSE(search().best(0.5 * wanted->cost(), kInfinity, execution_));
  EXPECT_FALSE(search().best(kInfinity, 0, execution_));
  IslandSearch own = search();
  const std::uint64_t bounded = counted([&] { EXPECT_TRUE(own.best(2 * wanted->cost(), kInfinity, execution_)); });
  EXPECT_LE(bounded, most);
  EXPECT_EQ(counted([&] { own.best(1.5 * wanted->cost(), kInfinity, execution_); }), 0u);
}

// Work that allows the first pieces alone: none is evened.
TEST_F(IslandsOfADome, AreNotEvenedWithoutWork) {
  const auto wanted = island_map(*part_->surface, {kEvenness}, execution_);
  IslandSearch short_of_work = search(), own = search();
  const std::uint64_t few = counted([&] { EXPECT_FALSE(short_of_work.best(2 * wanted->cost(), 1, execution_)); });
  const std::uint64_t all = counted([&] { EXPECT_TRUE(own.best(2 * wanted->cost(), kInfinity, execution_)); });
  EXPECT_LT(4 * few, all);
}

TEST_F(IslandsOfADome, OfASearchAtOnceLeaveTheWeightsAsTheyWere) {
  const auto wanted = island_map(*part_->surface, {kEvenness}, execution_);
  IslandSearch own = search();
  EXPECT_FALSE(own.at_once(0.1, execution_));
  EXPECT_EQ(own.best(kInfinity, kInfinity, execution_)->cost(), wanted->cost());
}

TEST_F(IslandsOfADome, BetweenChosenCutsLieForThemselves) {
  const auto whole = search().along({}, execution_);
  EXPECT_EQ(whole->islands, 1);
  EXPECT_TRUE(whole->seams.empty());
  std::vector<mesh::Pair> ring;  // all around, four rings below the tip
  const auto& points = part_->surface->polygons.vertices;
  const double height = std::cos(std::acos(1 - kDeep) * 4 / 24);
  for (const mesh::Pair& ends : part_->surface->edges) {
    if (std::abs(points[ends[0]][2] - height) < 1e-9 && std::abs(points[ends[1]][2] - height) < 1e-9)
      ring.push_back(ends);
  }
  const auto parted = search().along({ring, 0, 0}, execution_);
  EXPECT_EQ(parted->islands, 2);
  EXPECT_GE(parted->seams.size(), ring.size());
  const auto opened = search().along({{}, 0, 1.5}, execution_);
  EXPECT_EQ(opened->islands, 1);
  EXPECT_GT(opened->seams.size(), 0u);
  EXPECT_LT(opened->quality.density_ratio, whole->quality.density_ratio);
}

}  // namespace
}  // namespace holomorph::flat
