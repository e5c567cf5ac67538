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

// Cost of a map, above which poles are tried where the texture may turn: most tilings that turn cost 0.7 to 1.8.
constexpr double kPoorTurned = 2.0;

// The squares of a tiling that turns cost at least this part of what is guessed on few triangles: of 84 tilings nine in
// ten cost 0.79 to 1.43 times that, and three less than this, as thin shells, which few triangles do not keep.
constexpr double kOfGuess = 0.75;

// Works over that of a tiling that turns: of one without poles, with lines, on all triangles, and with poles.
constexpr double kOfNone = 0.5, kOfLines = 2, kOfPoles = 0.7;

// What rows that run along hard edges, and end there, are worth in the cost, which does not see them: for lines as long
// as the square root of the area, and at most. They are tried where there are as many, and up to so many triangles:
// objects that are made of such edges have few. Where seams may show, these lie there: of some 700 parts none got rows.
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
  if (!budget_.allows(expected_work())) return kInfinity;
  if (!ratio_without_poles_) {
    ratio_without_poles_ =
        structure_->tilers().ratio_without_poles(request_.tiling.boundary, request_.evenness > 0, execution);
  }
  return kRounded * std::log(std::max(*ratio_without_poles_, 1.0));
}

std::vector<MapPointer> TilingSearch::of_density(double density, int tries, Execution& execution) {
  const double tiles = density * part_->area;
  MapPointer first = nested(execution, 0, 1.0 / tries,
                            [&] { return least(candidates(tiles, tries > 1), nullptr, budget_, execution); });
  if (!first && refused_) std::rethrow_exception(refused_);
  if (!first) throw TopologyError("no tiling can be made");
  return resized(std::move(first), density, tries, execution);
}

std::vector<MapPointer> TilingSearch::resized(MapPointer first, double density, int tries, Execution& execution) {
  std::vector<MapPointer> tilings{std::move(first)};
  const TileOptions kind = tilings[0]->tiling()->asked;
  double tiles = kind.tiles, below = 0, above = kInfinity;
  for (int attempt = 1; attempt < tries; ++attempt) {
    const double size = relative_size(*tilings.back(), density);
    if (window_around().holds(size) || !budget_.goes_on()) break;
    size < 1 ? below = std::max(below, tiles) : above = std::min(above, tiles);
    tiles /= size;
    if (!(below < tiles && tiles < above)) tiles = std::sqrt(below * above);  // the density grows in steps
    const MapPointer made = nested(execution, static_cast<double>(attempt) / tries, (attempt + 1.0) / tries,
                                   [&] { return with_or_none(of_tiles(kind, tiles), execution); });
    if (!made) break;
    tilings.push_back(made);
  }
  return tilings;
}

MapPointer TilingSearch::moved(const std::vector<MapPointer>& tilings, double density, bool size_counts,
                               Execution& execution) {
  MapPointer made = nearest(tilings, density);
  if (request_.tiling.moves.empty()) return made;
  TileOptions options = of_tiles(made->tiling()->asked, made->tiling()->tiles);
  options.size_counts = size_counts;
  options.moves = request_.tiling.moves;
  return with(options, execution);
}

MapPointer TilingSearch::stretched(const Map& made, double density, Execution& execution) const {
  SeamlessPointer tiling = stretched_tiling(*made.tiling(), density / made.density(), part_->up, execution.workers());
  return tiling ? std::make_shared<const Map>(part_, structure_, std::move(tiling), execution) : nullptr;
}

MapPointer TilingSearch::less_level(const Map& made, double density, Execution& execution) {
  TileOptions options = of_tiles(made.tiling()->asked, density * part_->area);
  options.size_counts = true;
  options.max_turn = kMostTurned;
  return with_or_none(options, execution);
}

double TilingSearch::bound(double tiles, Execution& execution) {
  if (request_.tiling.turns != 1 && !request_.tiling.missing) return bound_of_turned(tiles, execution);
  return request_.tiling.poles.are_none() ? guess_without_poles(execution) : 0;
}

double TilingSearch::bound_of_turned(double tiles, Execution& execution) {
  if (!budget_.allows(expected_work())) return 0;
  const TileOptions turned = of_tiles(kind({}, request_.tiling.turns, tiling::Rows::kNone), tiles);
  return kOfGuess * structure_->tilers().guess_turned(turned, execution);
}

// Where the texture may turn: the tiling without poles whose rows all run round, if there is one; those that turn; and
// only shifted ones where these are poor, or impossible: their jumps are symmetries of the texture, too.
std::vector<Candidate> TilingSearch::candidates(double tiles, bool size_counts) {
  using tiling::Rows;
  const int turns = request_.tiling.turns;
  const double work = expected_work();
  const auto asked = [=, this](const PoleChoice& poles, int turns, Rows rows) {
    TileOptions result = of_tiles(kind(poles, turns, rows), tiles);
    result.size_counts = size_counts;
    return result;
  };
  const auto any = [](const MapPointer&, Execution&) { return 0.0; };
  const auto shifted = [=, this](const MapPointer&, Execution& execution) {
    return this->shifted(asked(request_.tiling.poles, 1, Rows::kNone), execution);
  };
  if (turns == 1) return {{work, any, shifted}};
  const TileOptions turned = asked(request_.tiling.poles, turns, Rows::kNone);
  const auto make_turned = [=, this](const MapPointer&, Execution& execution) {
    return with_or_none(turned, execution);
  };
  if (request_.tiling.missing) return {{work, any, make_turned}};
  std::vector<Candidate> result;
  if (request_.main == Main::kAutomatic && request_.tiling.poles.is_open() && has_tilings_without_poles()) {
    const auto bound = [this](const MapPointer&, Execution& execution) {
      const double guess = guess_without_poles(execution);
      return guess <= kRegular ? guess : kInfinity;
    };
    const auto make = [=, this](const MapPointer&, Execution& execution) -> MapPointer {
      const MapPointer made = with_or_none(asked({0, {}, {}}, 1, Rows::kNone), execution);
      return made && is_regular(*made) ? made : nullptr;
    };
    result.push_back({kOfNone * work, bound, make});
  }
  const auto rows = request_.rows.value_or(Rows::kNone);
  if (rows != Rows::kNone && (rows == Rows::kMirror || !edges_of_lines().empty())) {
    const auto make = [=, this](const MapPointer&, Execution& execution) {
      return with_or_none(asked(request_.tiling.poles, turns, rows), execution);
    };
    result.push_back({0, any, make});
  }
  const auto unless_done = [=, this](const MapPointer& best, const auto& bound) {
    const bool is_as_asked = best && best->tiling() && rows != Rows::kNone && best->tiling()->rows == rows;
    const bool is_done = is_as_asked || (best && (best->cost() <= kGood || is_regular(*best)));
    return is_done ? kInfinity : bound();
  };
  const auto bound_of_turned = [=, this](const MapPointer& best, Execution& execution) {
    return unless_done(best, [&] { return this->bound_of_turned(tiles, execution); });
  };
  result.push_back({work, bound_of_turned, make_turned});
  const bool may_be_lined = request_.main == Main::kSeamless && part_->triangle_count() <= kMostLinedTriangles;
  if (!request_.rows && turns != 6 && may_be_lined) {
    const auto bound = [=, this](const MapPointer& best, Execution&) {
      return best && best->tiling() && best->turns() == turns && length_of_lines() >= 1 ? 0 : kInfinity;
    };
    const auto make = [=, this](const MapPointer& best, Execution& execution) {
      return lined(best, asked(request_.tiling.poles, turns, Rows::kWhole), execution);
    };
    result.push_back({kOfLines * work, bound, make, 1, true});
  }
  const auto bound_of_shifted = [=, this](const MapPointer& best, Execution&) {
    const bool is_whole =
        best && (!best->tiling() || best->quality().lost_part == 0 || request_.tiling.poles.are_none());
    return is_whole && but_direction(*best) < kPoorTurned ? kInfinity : unless_done(best, [] { return 0.0; });
  };
  result.push_back({kOfPoles * work, bound_of_shifted, shifted});
  return result;
}

// The tiling whose rows end at hard edges, or run along them, if it costs hardly more than the one that turns and loses
// nothing; null if none does.
MapPointer TilingSearch::lined(const MapPointer& turned, TileOptions options, Execution& execution) {
  const double most = turned->cost() + std::min(kLined * length_of_lines(), kMostLined);
  for (const tiling::Rows rows : {tiling::Rows::kWhole, tiling::Rows::kFree}) {
    options.rows = rows;
    const MapPointer made = with_or_none(options, execution);
    if (made && made->quality().lost_part == 0 && made->cost() < most) return made;
  }
  return nullptr;
}

// Over the square root of the area.
double TilingSearch::length_of_lines() {
  double length = 0;
  for (const int e : edges_of_lines()) length += part_->surface->edge_lengths[e];
  return length / std::sqrt(part_->area);
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

// The one of least cost among those with the poles that are asked for, or, where that is left open, with as many as the
// density asks for, with none, or with two more: on few faces the density is less even than it was expected when poles
// were placed.
MapPointer TilingSearch::shifted(const TileOptions& options, Execution& execution) {
  const auto with_count = [&](int count) {
    TileOptions own = options;
    own.poles = {count, {}, options.poles.allowed};
    return with_or_none(own, execution);
  };
  const MapPointer first = with_or_none(options, execution);
  if (!options.poles.is_open() || (first && first->pole_count() == 0)) return first;
  MapPointer best = first;
  const bool may_have_none = has_tilings_without_poles() && (!first || budget_.goes_on());
  if (may_have_none && (!first || guess_without_poles(execution) < but_direction(*first)))
    best = cheaper(first, with_count(0));
  if (!first) return best;
  const bool is_evened = first->tiling()->evenness > 0 && first->tiling()->tiles >= kManyTiles;
  const bool are_few = is_evened && part_->triangle_count() <= kFewTriangles && first->drawn_range() > kUnevenTiling &&
                       first->pole_count() < kMostPoles;
  return are_few && budget_.goes_on() ? cheaper(best, with_count(first->pole_count() + kMorePoles)) : best;
}

TileOptions TilingSearch::kind(const PoleChoice& poles, int turns, tiling::Rows rows) const {
  TileOptions result = request_.tiling;
  result.poles = poles;
  result.poles.allowed = request_.tiling.poles.allowed;
  result.evenness = request_.evenness;
  result.moves.clear();
  if (request_.tiling.turns != 1) result.lattice = request_.tiling.turns == 6 ? kHex : kSquare;
  result.turns = turns;
  result.rows = rows;
  return result;
}

TileOptions TilingSearch::of_tiles(TileOptions kind, double tiles) {
  kind.tiles = tiles;
  return kind;
}

bool TilingSearch::is_regular(const Map& made) {
  return made.tiling() && made.turns() == 1 && made.pole_count() == 0 && made.quality().lost_part == 0 &&
         but_direction(made) <= kRegular;
}

// Null where it is refused.
MapPointer TilingSearch::with_or_none(const TileOptions& options, Execution& execution) {
  return unless_refused([&] { return with(options, execution); },
                        [&](const Error&) {
                          refused_ = std::current_exception();
                          return MapPointer();
                        });
}

// @throws what tilings throw; TopologyError where too much is lost
MapPointer TilingSearch::with(TileOptions options, Execution& execution) {
  options.marked = options.rows == tiling::Rows::kNone ? std::vector<mesh::Pair>() : marked();
  if (options.turns == 1 || options.rows != tiling::Rows::kNone) options.missing.reset();
  const SeamlessPointer made = structure_->tilers().tile(options, execution);
  if (const double lost = made->quality.lost_part; !(lost < kMostLost))
    throw TopologyError("it would lose " + percent(lost) + " of its area, as the mesh is too coarse: subdivide it");
  auto result = std::make_shared<SeamlessMap>(*made);
  result->asked = std::move(options);
  see_under_texture(*result);
  return std::make_shared<const Map>(part_, structure_, std::move(result), execution);
}

// With the direction that is seen of the texture it is made for: that may turn, too.
void TilingSearch::see_under_texture(SeamlessMap& made) const {
  const int turns = request_.tiling.turns;
  auto& direction = made.quality.direction;
  if (direction && direction->turns != turns) direction = uv::under(*direction, turns);
}

}  // namespace holomorph::choice
