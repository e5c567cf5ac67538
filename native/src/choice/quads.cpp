#include "choice/quads.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/constants.h"
#include "base/errors.h"
#include "tiles/quads.h"

namespace holomorph::choice {
namespace {

constexpr int kPerTile = 4;  // all cones lie at corners of two by two
constexpr int kRounds = 6;   // numbers of tiles, until there are about as many faces as are wanted
constexpr double kNearNumber = 0.03, kFolded = 0.05, kOther = 1.02, kMapping = 0.8;
// Parts of the area: rows that flip more are let go, and no other number of tiles is tried with them.
constexpr double kMostFlipped = 1e-3, kHopeless = 5e-3;
constexpr int kMostLoops = 50;    // whole numbers around more take minutes
constexpr double kMostOff = 1.5;  // times as many faces as are wanted: they are folded over each other

// The quads that a map has.
double count_of(const Part& part, const SeamlessMap& map) {
  double doubled = 0;
  for (const auto& [a, b, c] : part.surface->triangle_corners) {
    const Eigen::RowVector2d p = map.uv.row(b) - map.uv.row(a), q = map.uv.row(c) - map.uv.row(a);
    doubled += std::abs(p[0] * q[1] - p[1] * q[0]);
  }
  return kPerTile * doubled / 2;
}

// The map with about so many quads; numbers of tiles come in steps.
SeamlessPointer map_of(Tilers& tilers, const QuadOptions& asked, tiling::Rows rows, Execution& execution) {
  TileOptions options;
  options.turns = kPerTile;
  options.evenness = asked.evenness;
  options.rows = rows;
  if (rows == tiling::Rows::kWhole || rows == tiling::Rows::kFree) options.marked = asked.marked;
  options.tiles = asked.faces / kPerTile;
  SeamlessPointer best;
  double least = kInfinity, below = 0, above = kInfinity;
  for (int round = 0; round < kRounds && least > kNearNumber; ++round) {
    const double share = static_cast<double>(round) / kRounds;
    const SeamlessPointer made =
        nested(execution, share, share + 1.0 / kRounds, [&] { return tilers.tile(options, execution); });
    const double count = count_of(*tilers.part(), *made), off = std::abs(std::log(count / asked.faces));
    const double own = off + (made->quality.lost_part > 0 ? kFolded : 0);
    if (own < least) least = own, best = made;
    if (made->quality.lost_part > kHopeless) break;
    if (off <= kNearNumber) {  // but folded: another number may not be
      options.tiles *= kOther;
      continue;
    }
    count < asked.faces ? below = std::max(below, options.tiles) : above = std::min(above, options.tiles);
    options.tiles *= asked.faces / count;
    if (!(below < options.tiles && options.tiles < above)) options.tiles = std::sqrt(below * above);
    if (!std::isfinite(options.tiles)) break;
  }
  return best;
}

}  // namespace

Quads quads(Tilers& tilers, const QuadOptions& options, Execution& execution) {
  using tiling::Rows;
  const mesh::TopologicalType& type = tilers.part()->type;
  const int loops = 2 * type.genus + std::max(type.boundary_count - 1, 0);
  if (loops > kMostLoops) {
    throw TopologyError("it has " + std::to_string(loops) + " loops around handles and holes, which take long: quads " +
                        "are made of parts with up to " + std::to_string(kMostLoops));
  }
  Quads result;
  // Rows that are asked for, and those that ask for less.
  std::vector<Rows> all{options.lines};
  if (options.lines == Rows::kWhole) all.push_back(Rows::kFree);
  if (options.lines == Rows::kWhole || options.lines == Rows::kFree) all.push_back(Rows::kNone);
  for (const Rows rows : all) {
    const auto make = [&] {
      return nested(execution, 0, kMapping, [&] { return map_of(tilers, options, rows, execution); });
    };
    const bool is_needed = rows == all.back() && !result.map;
    const SeamlessPointer made =
        is_needed ? make() : unless_refused(make, [](const Error&) { return SeamlessPointer(); });
    if (made && (!result.map || made->quality.lost_part < result.map->quality.lost_part)) result.map = made;
    if (result.map && result.map->quality.lost_part <= kMostFlipped) break;
  }
  const Eigen::Map<const tiles::Corners> uv(result.map->uv.data(), result.map->uv.rows(), 2);
  const tiles::TileFrame frame{Eigen::Matrix2d::Identity(), Eigen::Vector2d::Zero(), 2 * Eigen::Matrix2i::Identity(),
                               kPerTile};
  const mesh::Surface& surface = *tilers.part()->surface;
  const tiles::TileCoordinates coordinates = tiles::tile_coordinates(surface, uv, frame, execution);
  const tiles::EdgeNodes nodes = tiles::edge_nodes(surface, coordinates, execution);
  const tiles::Pieces pieces = tiles::pieces(surface, coordinates, nodes, tiles::Pattern::grid, execution);
  result.cells = tiles::in_quads(surface, tiles::simplified(tiles::cells(pieces, execution)));
  if (static_cast<double>(result.cells.tiles.size()) > kMostOff * options.faces)
    throw TopologyError("so few quads would be folded over each other on it: take more faces");
  return result;
}

}  // namespace holomorph::choice
