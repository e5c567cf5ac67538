#include "choice/tiling_search.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <string>
#include <utility>

#include "base/constants.h"
#include "flat/arrangement.h"
#include "uv/appearance.h"

namespace holomorph::choice {
namespace {

constexpr double kMostLost = 0.02;  // part of the area that a tiling may flip or let collapse: more is seen

// What remains of the cost of the density that poles allow, once squares are rounded to whole tiles and evened, as it
// was seen on some thirty meshes: about.
constexpr double kRounded = 0.9;

// The evened size range above which two more poles are tried, where that is quick, and tiles are so many that their
// rounding decides less than the poles.
constexpr double kUnevenTiling = 1.73, kManyTiles = 60;
constexpr int kMorePoles = 2, kMostPoles = 16, kFewTriangles = 5000;

// Cost of a tiling without poles, expected and made, up to which the best map has no cones: all of its rows run round.
constexpr double kRegular = 1.1;

// Cost of a tiling that turns, above which one that is only shifted is tried: most cost 0.7 to 1.8.
constexpr double kPoorTurned = 2.0;

// What rows that run along hard edges, and end there, are worth in the cost, which does not see them: for lines as long
// as the square root of the area, and at most. They are tried where there are as many, and up to so many triangles:
// objects that are made of such edges have few.
constexpr double kLined = 0.1, kMostLined = 0.3;
constexpr int kMostLinedTriangles = 20'000;

// The work on a tiling for each triangle of the level that it is made on, of so many at least, and for each one of the
// part. So many loops double it, by their square.
constexpr double kLevelTriangle = 1e5, kTriangle = 5e3, kFewLoops = 20;
constexpr int kFew = 4000;

// Radians from the direction that is asked for, where no whole tiles of one size are nearer to it.
constexpr double kMostTurned = 0.5;
// Factor: whole tiles around a limb, from three on, are never further from the wanted size.
constexpr double kMostStretched = 1.35;
constexpr double kAlong = 1e-9;  // sine of an angle that is rounding

const std::array<Complex, 2> kSquare{1.0, Complex(0, 1)};
const std::array<Complex, 2> kHex{1.0, Complex(0.5, std::numbers::sqrt3 / 2)};

// A part of a whole in two digits, without an exponent.
std::string percent(double part) {
  std::ostringstream rounded, text;
  rounded.precision(2);
  rounded << 100 * part;
  text << std::stod(rounded.str()) << " %";
  return text.str();
}

double cost_of_direction(const uv::Quality& quality) {
  return quality.direction ? uv::cost_of_direction(*quality.direction) : 0;
}

// The cost of a tiling but for that of its direction, which bounds and guesses know nothing of.
double but_direction(const Map& made) { return made.cost() - cost_of_direction(made.quality()); }

MapPointer cheaper(const MapPointer& one, const MapPointer& other) {
  return !one || (other && other->cost() < one->cost()) ? other : one;
}

// The quality where all areas are multiplied. Their quantiles are, too: measured again, rounding might take another of
// two triangles between which the median is.
uv::Quality scaled(const SeamlessMap& before, const uv::UvArray& uv, double factor, uv::Up up, Workers& workers) {
  uv::Quality result = uv::quality(*before.triangulation, uv, workers);
  result.area = before.quality.area;
  for (double& area : result.area) area *= factor;
  result.median_density = factor * before.quality.median_density;
  result.density_ratio = before.quality.density_ratio;
  result.unseen_angle = before.quality.unseen_angle;
  if (before.quality.direction)
    result.direction = uv::direction(*before.triangulation, uv, up, before.quality.direction->turns, workers);
  return result;
}

// The tiling with this multiple of its density, stretched across its jumps where these all run along one line, as
// around a limb with a pole at each end: no seam shows all the same. Null where there are jumps both ways, or it would
// be stretched by more than `kMostStretched`.
SeamlessPointer stretched_tiling(const SeamlessMap& tiling, double factor, uv::Up up, Workers& workers) {
  std::vector<Complex> jumps = tiling.residues;
  for (const auto& [m, n] : tiling.periods)
    jumps.push_back(static_cast<double>(m) * tiling.lattice[0] + static_cast<double>(n) * tiling.lattice[1]);
  if (jumps.empty() || !(1 / kMostStretched <= factor && factor <= kMostStretched)) return nullptr;
  const Complex line = *std::ranges::max_element(jumps, {}, [](const Complex& z) { return std::abs(z); });
  for (const Complex jump : jumps) {
    if (!(std::abs((std::conj(line) * jump).imag()) <= kAlong * std::norm(line))) return nullptr;
  }
  // Both sides of a cut are as far across the line, exactly, and are shifted by the same.
  const Eigen::Vector2d across(-line.imag(), line.real());
  uv::UvArray shift = ((factor - 1) / std::norm(line)) * (tiling.uv * across) * across.transpose();
  flat::round_to_grid(shift);
  auto result = std::make_shared<SeamlessMap>(tiling);
  result->uv += shift;
  result->tiles *= factor;
  result->quality = scaled(tiling, result->uv, factor, up, workers);
  result->made = nullptr;
  return result;
}

}  // namespace

TilingSearch::TilingSearch(PartPointer part, StructurePointer structure, Request request, Budget& budget)
    : part_(std::move(part)), structure_(std::move(structure)), request_(std::move(request)), budget_(budget) {}

bool TilingSearch::is_strict() const {
  const TileOptions& asked = request_.tiling;
  const bool is_chosen = !asked.poles.is_open() && !asked.poles.are_none();
  return is_chosen || asked.max_added || !asked.poles.allowed.empty() || !asked.moves.empty() || asked.missing;
}

double TilingSearch::expected_work() const {
  const double loops = std::max(2 * part_->type.genus + part_->type.boundary_count - 1, 0) / kFewLoops;
  const int count = part_->triangle_count();
  return (kLevelTriangle * std::clamp(count, kFew, tiling::kLevelTriangles) + kTriangle * count) * (1 + loops * loops);
}

double TilingSearch::guess_without_poles(Execution& execution) {
  if (!ratio_without_poles_) {
    ratio_without_poles_ =
        structure_->tilers().ratio_without_poles(request_.tiling.boundary, request_.evenness > 0, execution);
  }
  return kRounded * std::log(std::max(*ratio_without_poles_, 1.0));
}

std::vector<MapPointer> TilingSearch::of_density(double density, int tries, Execution& execution) {
  std::vector<MapPointer> tilings;
  double tiles = density * part_->area, below = 0, above = kInfinity;
  for (int attempt = 0; attempt < tries; ++attempt) {
    if (!tilings.empty() && !budget_.goes_on()) break;
    const auto next = [&] {
      return nested(execution, static_cast<double>(attempt) / tries, (attempt + 1.0) / tries,
                    [&] { return of_tiles({.tiles = tiles, .size_counts = tries > 1}, execution); });
    };
    const MapPointer made = tilings.empty() ? next() : unless_refused(next, [](const Error&) { return MapPointer(); });
    if (!made) break;
    tilings.push_back(made);
    const double size = relative_size(*made, density);
    if (window_around().holds(size)) break;
    size < 1 ? below = std::max(below, tiles) : above = std::min(above, tiles);
    tiles /= size;
    if (!(below < tiles && tiles < above)) tiles = std::sqrt(below * above);  // the density grows in steps
  }
  return tilings;
}

MapPointer TilingSearch::moved(const std::vector<MapPointer>& tilings, double density, bool size_counts,
                               Execution& execution) {
  MapPointer made = nearest(tilings, density);
  if (request_.tiling.moves.empty()) return made;
  return of_tiles({made->tiling()->tiles, size_counts, {}, request_.tiling.moves}, execution);
}

MapPointer TilingSearch::stretched(const Map& made, double density, Execution& execution) const {
  SeamlessPointer tiling = stretched_tiling(*made.tiling(), density / made.density(), part_->up, execution.workers());
  return tiling ? std::make_shared<const Map>(part_, structure_, std::move(tiling), execution) : nullptr;
}

MapPointer TilingSearch::turned(double density, Execution& execution) {
  return unless_refused(
      [&] {
        return of_tiles({density * part_->area, true, kMostTurned}, execution);
      },
      [](const Error&) { return MapPointer(); });
}

// One that turns where that is asked for; one that is only shifted where that is impossible, or where the other is poor
// or loses triangles and it costs less: its jumps are symmetries of the texture, too.
MapPointer TilingSearch::of_tiles(Size size, Execution& execution) {
  using tiling::Rows;
  const int turns = request_.tiling.turns;
  if (turns == 1) return shifted(size, execution);
  if (request_.tiling.missing) return with(request_.tiling.poles, size, turns, Rows::kNone, execution);
  size.is_of_turns = true;
  const std::optional<Rows> rows = request_.rows;
  const bool are_edged = rows == Rows::kWhole || rows == Rows::kFree;
  if (rows == Rows::kMirror || (are_edged && !edges_of_lines().empty())) {
    if (MapPointer made = with_turns(size, *rows, execution)) return made;
  }
  if (MapPointer made = regular(size, execution)) return made;
  const MapPointer turned = with_turns(size, Rows::kNone, execution);
  if (!turned) return shifted(size, execution);
  if (!rows && turns != 6) {
    if (MapPointer made = lined(turned, size, execution)) return made;
  }
  if (turned->quality().lost_part == 0 && (but_direction(*turned) < kPoorTurned || !budget_.goes_on())) return turned;
  return unless_refused([&] { return cheaper(turned, shifted(size, execution)); },
                        [&](const Error&) { return turned; });
}

// The tiling whose rows end at hard edges, or run along them, if it costs hardly more than the one that turns and loses
// nothing; null if none does.
MapPointer TilingSearch::lined(const MapPointer& turned, const Size& size, Execution& execution) {
  if (part_->triangle_count() > kMostLinedTriangles) return nullptr;
  double length = 0;
  for (const int e : edges_of_lines()) length += part_->surface->edge_lengths[e];
  length /= std::sqrt(part_->area);
  if (length < 1 || !budget_.goes_on()) return nullptr;
  const double most = turned->cost() + std::min(kLined * length, kMostLined);
  for (const tiling::Rows rows : {tiling::Rows::kWhole, tiling::Rows::kFree}) {
    const MapPointer made = with_turns(size, rows, execution);
    if (made && made->quality().lost_part == 0 && made->cost() < most) return made;
  }
  return nullptr;
}

// The marked edges that may be lines: all where lines are asked for.
std::vector<mesh::Pair> TilingSearch::marked() const {
  const std::vector<mesh::Pair>& all = request_.tiling.marked;
  const bool are_asked = request_.rows == tiling::Rows::kWhole || request_.rows == tiling::Rows::kFree;
  return are_asked || (!all.empty() && tiling::are_whole(all)) ? all : std::vector<mesh::Pair>();
}

const std::vector<int>& TilingSearch::edges_of_lines() {
  if (!edges_of_lines_) edges_of_lines_ = tiling::found_lines(*part_->surface, marked());
  return *edges_of_lines_;
}

MapPointer TilingSearch::with_turns(const Size& size, tiling::Rows rows, Execution& execution) {
  return unless_refused([&] { return with(request_.tiling.poles, size, request_.tiling.turns, rows, execution); },
                        [](const Error&) { return MapPointer(); });
}

// The tiling without poles where the best map is asked for and needs no cones; else null.
MapPointer TilingSearch::regular(const Size& size, Execution& execution) {
  const PoleChoice& poles = request_.tiling.poles;
  const bool is_best = request_.main == Main::kAutomatic && poles.is_open() && has_tilings_without_poles();
  if (!is_best || guess_without_poles(execution) > kRegular) return nullptr;
  const MapPointer made = unless_refused(
      [&] {
        return with({0, {}, poles.allowed}, size, 1, tiling::Rows::kNone, execution);
      },
      [](const Error&) { return MapPointer(); });
  return made && made->quality().lost_part == 0 && but_direction(*made) <= kRegular ? made : nullptr;
}

// The one of least cost among those with the poles that are asked for, or, where that is left open, with as many as the
// density asks for, with none, or with two more: on few faces the density is less even than it was expected when poles
// were placed.
MapPointer TilingSearch::shifted(const Size& size, Execution& execution) {
  const PoleChoice& poles = request_.tiling.poles;
  const auto with_count = [&](int count) {
    return with({count, {}, poles.allowed}, size, 1, tiling::Rows::kNone, execution);
  };
  const auto as_asked = [&] { return with(poles, size, 1, tiling::Rows::kNone, execution); };
  if (!poles.is_open()) return as_asked();
  const bool may_have_none = has_tilings_without_poles();
  const MapPointer first =
      may_have_none ? unless_refused(as_asked, [](const Error&) { return MapPointer(); }) : as_asked();
  if (!first) return with_count(0);
  if (first->pole_count() == 0) return first;
  MapPointer best = first;
  if (may_have_none && budget_.goes_on()) {
    best = unless_refused(
        [&] { return guess_without_poles(execution) < but_direction(*first) ? cheaper(first, with_count(0)) : first; },
        [&](const Error&) { return first; });
  }
  return with_more_poles(*first, best, with_count);
}

template <class WithCount>
MapPointer TilingSearch::with_more_poles(const Map& first, const MapPointer& best, const WithCount& with_count) {
  const bool is_evened = first.tiling()->evenness > 0 && first.tiling()->tiles >= kManyTiles;
  const bool is_quick = part_->triangle_count() <= kFewTriangles;
  const bool are_few = is_evened && is_quick && first.drawn_range() > kUnevenTiling && first.pole_count() < kMostPoles;
  if (!are_few || !budget_.goes_on()) return best;
  return unless_refused([&] { return cheaper(best, with_count(first.pole_count() + kMorePoles)); },
                        [&](const Error&) { return best; });
}

// @throws what tilings throw; TopologyError where too much is lost
MapPointer TilingSearch::with(const PoleChoice& poles, const Size& size, int turns, tiling::Rows rows,
                              Execution& execution) {
  TileOptions options = request_.tiling;
  options.poles = poles;
  options.tiles = size.tiles;
  options.evenness = request_.evenness;
  options.size_counts = size.size_counts;
  options.max_turn = size.max_turn.value_or(options.max_turn);
  options.moves = size.moves;
  if (size.is_of_turns) options.lattice = request_.tiling.turns == 6 ? kHex : kSquare;
  options.turns = turns;
  options.rows = rows;
  options.marked = rows == tiling::Rows::kNone ? std::vector<mesh::Pair>() : marked();
  if (turns == 1 || rows != tiling::Rows::kNone) options.missing.reset();
  SeamlessPointer made = structure_->tilers().tile(options, execution);
  if (const double lost = made->quality.lost_part; !(lost < kMostLost))
    throw TopologyError("it would lose " + percent(lost) + " of its area, as the mesh is too coarse: subdivide it");
  return std::make_shared<const Map>(part_, structure_, under_texture(std::move(made)), execution);
}

// The tiling with the direction that is seen of the texture it is made for: that may turn, too.
SeamlessPointer TilingSearch::under_texture(SeamlessPointer made) const {
  const int turns = request_.tiling.turns;
  const auto& direction = made->quality.direction;
  if (!direction || direction->turns == turns) return made;
  auto result = std::make_shared<SeamlessMap>(*made);
  result->quality.direction = uv::under(*direction, turns);
  return result;
}

}  // namespace holomorph::choice
