#include "choice/pieces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>

#include "choice/any_structure.h"
#include "choice/automatic_structure.h"
#include "choice/request.h"
#include "choice/tiling_search.h"
#include "choice/turned_parts.h"

namespace holomorph::choice {
namespace {

using Complex = std::complex<double>;

constexpr int kRings = 6, kRound = 32;
constexpr double kTolerance = 1e-9;

PartPointer with_window() {
  return tube(kRings, kRound, [](int ring, int i) { return ring != 3 || i < 4 || i > 6; });
}

TEST(Pieces, AWindowIsClosedWhileATubeIsMapped) {
  Execution execution(1);
  execution.stage("map", 0.0, 1.0);
  const PartPointer part = with_window(), filled = closed(part, execution);
  EXPECT_EQ(part->type.boundary_count, 3);
  EXPECT_EQ(filled->type.boundary_count, 2);
  EXPECT_EQ(closed(filled, execution), filled);
  const std::vector<int>&before = part->surface->polygons.corner_vertices,
        &after = filled->surface->polygons.corner_vertices;
  EXPECT_TRUE(std::equal(before.begin(), before.end(), after.begin()));
  EXPECT_EQ(after.size(), before.size() + 8);  // the rim of the window is the one polygon

  Request request{.part = filled, .main = Main::kSeamless};
  request.tiling.poles.count = 0;
  Budget budget(filled->triangle_count());
  TilingSearch search(filled, automatic_structure(filled, {}, execution), request, budget);
  const MapPointer made = search.of_density(20, 1, execution).front(), again = opened(made, part, execution);
  EXPECT_EQ(again->part(), part);
  const auto corners = static_cast<Eigen::Index>(before.size());
  ASSERT_EQ(again->uv().rows(), corners);
  EXPECT_EQ(again->uv(), made->uv().topRows(corners));
  EXPECT_EQ(std::ssize(again->quality().angle), part->triangle_count());
  EXPECT_EQ(again->quality().direction.has_value(), made->quality().direction.has_value());
  EXPECT_EQ(again->why(), made->why());
  const std::vector<mesh::Pair> edges = sorted_pairs({part->surface->edges.begin(), part->surface->edges.end()});
  EXPECT_FALSE(again->tiling()->seams.empty());
  for (const auto& [a, b] : again->tiling()->seams) EXPECT_TRUE(holds(edges, a, b));
  EXPECT_EQ(opened(made, filled, execution), made);
}

TEST(Pieces, ArePartsWithIndicesOfTheWhole) {
  Execution execution(1);
  const PartPointer whole = tube(kRings, kRound);
  std::vector<int> names(kRings * kRound, 7);
  std::fill(names.begin() + 2 * kRound, names.end(), 3);
  const std::vector<Piece> found = cut_apart(*whole, names, execution);
  ASSERT_EQ(found.size(), 2u);
  double area = 0;
  std::vector<int> corners;
  for (const Piece& piece : found) {
    area += piece.part->area;
    EXPECT_EQ(piece.name, names[static_cast<std::size_t>(piece.face_index.front())]);
    EXPECT_EQ(std::ssize(piece.face_index), (piece.name == 7 ? 2 : kRings - 2) * kRound);
    const mesh::Polygons &own = piece.part->surface->polygons, &all = whole->surface->polygons;
    for (std::size_t c = 0; c < piece.corner_index.size(); ++c) {
      const auto v = static_cast<std::size_t>(own.corner_vertices[c]);
      EXPECT_EQ(piece.vertex_index[v], all.corner_vertices[static_cast<std::size_t>(piece.corner_index[c])]);
      EXPECT_EQ(piece.part->labels[v], piece.vertex_index[v]);
    }
    corners.insert(corners.end(), piece.corner_index.begin(), piece.corner_index.end());
  }
  EXPECT_NEAR(area, whole->area, kTolerance * area);
  std::ranges::sort(corners);
  for (std::size_t c = 0; c < corners.size(); ++c) EXPECT_EQ(corners[c], static_cast<int>(c));
  EXPECT_EQ(corners.size(), whole->surface->polygons.corner_vertices.size());
}

// A sector of a ring in polar coordinates: in the plane its rows turn by its angle, half either way.
TEST(Pieces, RowsThatTurnAreToldFromATurnedMap) {
  constexpr double kAngle = 0.6;
  constexpr int kMany = 64;
  const PartPointer part = tube(kRings, kMany);
  uv::UvArray polar(part->surface->polygons.corner_vertices.size(), 2), plain = polar, quarter = polar;
  for (int ring = 0; ring < kRings; ++ring) {
    for (int i = 0; i < kMany; ++i) {
      for (int corner = 0; corner < 4; ++corner) {
        const double turn = kAngle * (i + (corner == 1 || corner == 2)) / kMany, rise = corner >= 2;
        const Complex z(std::log(1 + 0.01 * (ring + rise)), turn), w = std::exp(z);
        const Eigen::Index c = 4 * (ring * kMany + i) + corner;
        polar.row(c) << w.real(), w.imag();
        plain.row(c) << z.real(), z.imag();
        quarter.row(c) << -z.imag(), z.real();
      }
    }
  }
  Piece piece;
  piece.part = part;
  EXPECT_EQ(turn_against(piece, plain), 0);  // without islands
  piece.uv = polar;
  EXPECT_NEAR(turn_against(piece, plain), kAngle / 4, 0.01 * kAngle);
  EXPECT_NEAR(turn_against(piece, quarter), kAngle / 4, 0.01 * kAngle);
  piece.uv = plain;
  EXPECT_NEAR(turn_against(piece, quarter), 0, kTolerance);
}

}  // namespace
}  // namespace holomorph::choice
