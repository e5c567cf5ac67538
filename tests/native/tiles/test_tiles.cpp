// Exact decisions, and pieces that fit side by side.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include "mesh/make_surface.h"
#include "tiles/cells.h"
#include "tiles/lines_and_places.h"
#include "tiles/quads.h"

namespace holomorph::tiles {
namespace {

constexpr int kColumns = 14, kRows = 11, kAround = 7, kAlong = 5;  // of the torus; tiles of its map

struct Tiled {
  mesh::Surface surface;
  Corners uv;
};

mesh::Surface torus(Execution& execution) {
  mesh::Polygons polygons;
  for (int i = 0; i < kColumns; ++i) {
    for (int j = 0; j < kRows; ++j) {
      const double a = 2 * std::numbers::pi * i / kColumns, b = 2 * std::numbers::pi * j / kRows;
      polygons.vertices.push_back({(2 + std::cos(b)) * std::cos(a), (2 + std::cos(b)) * std::sin(a), std::sin(b)});
    }
  }
  for (int i = 0; i < kColumns; ++i) {
    for (int j = 0; j < kRows; ++j) {
      const int right = (i + 1) % kColumns, up = (j + 1) % kRows;
      const int a = i * kRows + j, b = right * kRows + j, c = right * kRows + up, d = i * kRows + up;
      for (const int v : {a, b, c, a, c, d}) polygons.corner_vertices.push_back(v);
    }
  }
  for (std::size_t c = 0; c <= polygons.corner_vertices.size(); c += 3)
    polygons.face_offsets.push_back(static_cast<int>(c));
  return mesh::make_surface(std::move(polygons), execution);
}

// Vertices moved farther than their neighbours are, many of them to lines between tiles.
Tiled folded_torus(int seed, Execution& execution) {
  Tiled result{torus(execution), {}};
  std::mt19937 numbers(static_cast<unsigned>(seed));
  const auto draw = [&] { return static_cast<double>(numbers()) / 0x1p32; };
  std::vector<Eigen::Vector2d> at;
  for (int i = 0; i < kColumns; ++i) {
    for (int j = 0; j < kRows; ++j) {
      Eigen::Vector2d p{(i + 2 * draw() - 1) * kAround / kColumns, (j + 2 * draw() - 1) * kAlong / kRows};
      for (double& x : p) x = draw() < 0.4 ? std::round(x) : x;
      at.push_back(p);
    }
  }
  const auto& corners = result.surface.polygons.corner_vertices;
  result.uv.resize(static_cast<Eigen::Index>(corners.size()), 2);
  const Eigen::Array2d size(kAround, kAlong);
  for (std::size_t c = 0; c < corners.size(); ++c) {
    const Eigen::Array2d first = at[corners[c - c % 3]], own = at[corners[c]];
    result.uv.row(static_cast<Eigen::Index>(c)) = own - ((own - first) / size).round() * size;
  }
  return result;
}

TileFrame frame(int columns, int rows) {
  return {Eigen::Matrix2d::Identity(), Eigen::Vector2d::Zero(), Eigen::Vector2i(columns, rows).asDiagonal()};
}

TEST(Orientation, IsExactWhereAProductIsRounded) {
  const double a = 0x1p50 - 1, b = 0x1p50 - 3;
  EXPECT_EQ(determinant(a, a, b, b), 0);
  EXPECT_EQ(determinant(a, a - 1, a + 1, a), 1);  // a^2 - (a - 1) (a + 1)
  EXPECT_EQ(determinant(a - 1, a, a, a + 1), -1);
  EXPECT_GT(orientation({-a, -a}, {a, a}, {-1, 0}), 0);
  EXPECT_LT(orientation({-a, -a}, {a, a}, {1, 0}), 0);
  EXPECT_EQ(orientation({-a, -a}, {a, a}, {7, 7}), 0);
}

class Folded : public testing::TestWithParam<int> {};

TEST_P(Folded, PiecesFitSideBySideAndHaveTheArea) {
  Execution execution(2);
  const Tiled tiled = folded_torus(GetParam(), execution);
  for (const Pattern pattern : {Pattern::grid, Pattern::bricks}) {
    const auto coordinates = tile_coordinates(tiled.surface, tiled.uv, frame(4, 2), execution);
    const EdgeNodes nodes = edge_nodes(tiled.surface, coordinates, execution);
    const Pieces all = pieces(tiled.surface, coordinates, nodes, pattern, execution);
    std::map<int, std::vector<std::pair<int, int>>> ends;  // of each segment
    double area = 0;
    for (std::size_t f = 0; f + 1 < all.offsets.size(); ++f) {
      for (int s = all.offsets[f]; s < all.offsets[f + 1]; ++s) {
        const int next = s + 1 < all.offsets[f + 1] ? s + 1 : all.offsets[f];
        ends[all.side_segments[s]].emplace_back(all.side_nodes[s], all.side_nodes[next]);
        const Point &a = all.side_points[s], &b = all.side_points[next];
        area += (a[0] * b[1] - a[1] * b[0]) / 2;
      }
    }
    for (const auto& [segment, both] : ends) {
      ASSERT_EQ(both.size(), 2);
      EXPECT_EQ(both[0].first, both[1].second);
      EXPECT_EQ(both[0].second, both[1].first);
    }
    EXPECT_NEAR(area, 8 * kAround * kAlong, 1e-8);
    const Cells made = cells(all, execution);
    std::vector<char> is_end(made.vertices.triangles.size(), 0);
    for (const int vertex : made.corner_vertices) is_end[vertex] = 1;
    EXPECT_EQ(std::count(is_end.begin(), is_end.end(), 0), 0);
  }
}

TEST_P(Folded, PlacesAreTheDegree) {
  Execution execution(2);
  const Tiled tiled = folded_torus(GetParam(), execution);
  TileFrame shifted = frame(3, 5);
  shifted.origin = {0.123, 0.077};
  const auto coordinates = tile_coordinates(tiled.surface, tiled.uv, shifted, execution);
  const Places found = places(tiled.surface, coordinates, execution);
  EXPECT_EQ(std::ssize(found.triangles) - found.flipped, 15 * kAround * kAlong);
  const Lines along = lines(tiled.surface, coordinates, execution);
  EXPECT_EQ(std::count(along.is_closed.begin(), along.is_closed.end(), 0), 0);
}

// Vertices, less edges, plus polygons; each edge has two polygons, one on each side.
int euler_characteristic(const Cells& cells) {
  std::map<std::pair<int, int>, int> sides;
  for (std::size_t f = 0; f + 1 < cells.offsets.size(); ++f) {
    for (int c = cells.offsets[f]; c < cells.offsets[f + 1]; ++c) {
      const int next = c + 1 < cells.offsets[f + 1] ? c + 1 : cells.offsets[f];
      ++sides[{cells.corner_vertices[c], cells.corner_vertices[next]}];
    }
  }
  for (const auto& [ends, count] : sides) {
    EXPECT_EQ(count, 1);
    EXPECT_EQ(sides.count({ends.second, ends.first}), 1);
  }
  return static_cast<int>(cells.vertices.triangles.size() + cells.tiles.size()) - static_cast<int>(sides.size() / 2);
}

int even_polygons(const Cells& cells) {
  int result = 0;
  for (std::size_t f = 0; f + 1 < cells.offsets.size(); ++f) {
    const int count = cells.offsets[f + 1] - cells.offsets[f];
    result += count > 4 && count % 2 == 0;
  }
  return result;
}

TEST_P(Folded, CellsBecomeQuadsAndStayATorus) {
  Execution execution(1);
  const Tiled tiled = folded_torus(GetParam(), execution);
  const auto coordinates = tile_coordinates(tiled.surface, tiled.uv, frame(2, 2), execution);
  const EdgeNodes nodes = edge_nodes(tiled.surface, coordinates, execution);
  const Cells simple =
      simplified(cells(pieces(tiled.surface, coordinates, nodes, Pattern::grid, execution), execution));
  EXPECT_EQ(euler_characteristic(simple), 0);
  const Cells quads = in_quads(tiled.surface, simple);
  EXPECT_EQ(euler_characteristic(quads), 0);
  EXPECT_GT(even_polygons(simple), 0);
  EXPECT_LT(even_polygons(quads), even_polygons(simple) / 2);  // some have no diagonal that is no edge yet
  EXPECT_EQ(quads.corner_points.size(), quads.corner_vertices.size());
}

INSTANTIATE_TEST_SUITE_P(Seeds, Folded, testing::Range(0, 10));

}  // namespace
}  // namespace holomorph::tiles
