#include "choice/tilers.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

#include "mesh/half_edges.h"
#include "tiling/tiling.h"

namespace holomorph::choice {
namespace {

constexpr double kPlacing = 0.6;  // part of the work on a tiling, for finding the poles

std::array<double, 3> up_vector(uv::Up up) {
  return up == uv::Up::kY ? std::array{0.0, 1.0, 0.0} : std::array{0.0, 0.0, 1.0};
}

// Whether a polygon has three corners in a row on one boundary loop.
bool has_angle_on_one_boundary(const mesh::Surface& surface, Execution& execution) {
  const auto loops = mesh::boundary_loops(surface, mesh::half_edges(surface, execution)).loop_of_vertex;
  const auto& [vertices, corners, offsets, file] = surface.polygons;
  for (std::size_t f = 0; f + 1 < offsets.size(); ++f) {
    const int begin = offsets[f], count = offsets[f + 1] - begin;
    const auto loop = [&](int k) { return loops[corners[begin + k % count]]; };
    for (int i = 0; i < count; ++i) {
      if (loop(i) >= 0 && loop(i) == loop(i + 1) && loop(i) == loop(i + 2)) return true;
    }
  }
  return false;
}

std::string counted_poles(std::size_t count) { return std::to_string(count) + (count == 1 ? " pole" : " poles"); }

// Refuses a map with more added distortion than is wanted, and says what can be had instead.
void check_added(const SeamlessMap& made, std::optional<double> most, int genus) {
  if (!most || made.added_distortion <= *most) return;
  const bool has_poles = made.turns == 1;
  std::ostringstream text;
  text << "with ";
  if (has_poles) text << counted_poles(made.poles.size()) << " and ";
  text.precision(4);
  text << made.tiles;
  text.precision(5);
  text << " tiles the added distortion is " << made.added_distortion << ", more than max_added, " << *most << ": ";
  if (!has_poles || std::ssize(made.poles) >= genus) {
    text << "take more tiles";
  } else {
    text << "take " << counted_poles(static_cast<std::size_t>(genus)) << " or more, or more tiles";
  }
  throw TopologyError(text.str());
}

tiling::PoleOptions pole_options(const Part& part, const PoleChoice& poles, BoundaryLines boundary, bool is_evened,
                                 const std::string& solver, std::shared_ptr<const tiling::Levels> levels,
                                 Execution& execution) {
  const bool is_straight = boundary == BoundaryLines::kAutomatic
                               ? !(is_evened && has_angle_on_one_boundary(*part.surface, execution))
                               : boundary == BoundaryLines::kStraight;
  return {poles.count, poles.vertices, poles.allowed, is_straight, part.labels, {solver}, is_evened, std::move(levels)};
}

// Throws for choices that a tiling that turns has not.
void check_turned(const TileOptions& options) {
  const auto refuse = [](const char* name) {
    throw std::invalid_argument(std::string("a tiling that turns has no choice of ") + name + ": take turns=1");
  };
  if (!options.poles.is_open() && !options.poles.are_none()) refuse("poles");
  if (!options.poles.allowed.empty()) refuse("where poles are allowed");
  if (!options.moves.empty()) refuse("moves of poles");
  if (options.turn.value_or(0) != 0) refuse("turn");
  if (options.boundary != BoundaryLines::kAutomatic) refuse("boundary");
}

}  // namespace

Tiler::Tiler(PartPointer part, const PoleChoice& poles, BoundaryLines boundary, bool is_evened,
             const std::string& solver, std::shared_ptr<const tiling::Levels> levels, const Tiler* like,
             Execution& execution)
    : part_(std::move(part)),
      placement_(tiling::place(part_->surface,
                               pole_options(*part_, poles, boundary, is_evened, solver, std::move(levels), execution),
                               execution, like ? &like->placement_ : nullptr)) {}

SeamlessPointer Tiler::tile(const TileOptions& options, Execution& execution) const {
  tiling::TilingOptions asked{options.tiles,
                              {options.lattice[0], options.lattice[1]},
                              {},
                              options.turn,
                              options.max_turn,
                              options.evenness,
                              options.size_counts};
  const bool is_upright = options.heading.is_upright();
  if (is_upright && part_->has_positions()) {  // u runs along what is up, a quarter turn from v
    asked.direction = up_vector(part_->up);
    asked.turn = std::numbers::pi / 2 + options.turn.value_or(0);
  } else if (options.heading.kind == Heading::Kind::kVector) {
    if (!part_->has_positions())
      throw InvalidMesh("an intrinsic surface, without positions, has no direction in space; use turn");
    asked.direction = options.heading.vector;
  }
  SeamlessPointer made = value(tiling::tile(placement_, asked, execution), is_upright, execution);
  check_added(*made, options.max_added, part_->type.genus);
  return made;
}

SeamlessPointer Tiler::evened(const SeamlessMap& tiling, double evenness, Execution& execution) const {
  return value(tiling::evened(*tiling.made, evenness, execution), tiling.quality.direction.has_value(), execution);
}

SeamlessPointer Tiler::moved(const SeamlessMap& tiling, const std::vector<tiling::PoleMove>& moves, double evenness,
                             Execution& execution) const {
  return value(tiling::move_poles(placement_, *tiling.made, moves, evenness, execution),
               tiling.quality.direction.has_value(), execution);
}

SeamlessPointer Tiler::value(tiling::Tiling tiling, bool is_upright, Execution& execution) const {
  auto made = std::make_shared<const tiling::Tiling>(std::move(tiling));
  const tiling::ConformalTiling& conformal = *made->conformal;
  const tiling::RoundingProblem& problem = *conformal.form.problem;
  auto result = std::make_shared<SeamlessMap>();
  result->uv = made->uv;
  result->triangulation = conformal.structure->surface;
  const bool has_up = is_upright && part_->has_positions();
  result->quality = tiling::quality(*made, has_up ? std::optional(part_->up) : std::nullopt, execution);
  result->tiles = problem.tiles;
  result->evenness = made->evenness;
  result->lattice = {problem.lattice.a, problem.lattice.b};
  for (const int e : conformal.structure->topology.seams) result->seams.push_back(result->triangulation->edges[e]);
  for (const Complex period : conformal.seamless.periods) {
    const Eigen::Vector2d own = problem.lattice.coordinates(period);
    result->periods.push_back({std::llrint(own[0]), std::llrint(own[1])});
  }
  result->poles = conformal.poles;
  result->residues = conformal.residues;
  result->zeros = uv::zeros(*result->triangulation, made->uv, conformal.poles);
  result->added_distortion = conformal.distortion;
  result->beltrami_rms = conformal.beltrami_rms;
  result->optimal_size_range = std::sqrt(placement_.optimal_density_ratio);
  result->rounding = conformal.form.record;
  result->made = std::move(made);
  return result;
}

SeamlessPointer turned_tiling(tiling::TurnedTiler& tiler, const Part& part, int turns, double tiles, double evenness,
                              Execution& execution) {
  if (!(tiles > 0)) tiles = tiler.usual_tiles();
  tiling::TurnedTiling tiling = tiler.tile(tiles, evenness, execution);
  auto result = std::make_shared<SeamlessMap>();
  result->uv = std::move(tiling.map.uv);
  result->quality = std::move(tiling.quality);
  result->added_distortion = tiling.added_distortion;
  result->beltrami_rms = tiling.beltrami_rms;
  result->triangulation = part.surface;
  result->tiles = tiles;
  result->evenness = evenness;
  result->lattice = {1.0, turns == 6 ? Complex(0.5, std::numbers::sqrt3 / 2) : Complex(0, 1)};
  result->rounding.integers = 2 * static_cast<int>(tiling.map.missing.size());
  result->turns = turns;
  result->cones = std::move(tiling.map.cones);
  for (const int missing : tiling.map.missing) {
    result->cone_angles.push_back(1 - static_cast<double>(missing) / turns);
  }
  for (const tiling::Jump& jump : tiling.map.jumps) {
    result->seams.push_back(part.surface->edges[jump.edge]);
    result->jumps.push_back({jump.turn, jump.translation[0], jump.translation[1]});
  }
  result->rows = tiling.rows;
  return result;
}

std::shared_ptr<const tiling::Levels> Tilers::levels(Execution& execution) {
  return levels_.get(0, [&] { return std::make_shared<const tiling::Levels>(part_->surface, execution); });
}

double Tilers::ratio_without_poles(BoundaryLines boundary, bool is_evened, Execution& execution) {
  const tiling::PoleOptions options =
      pole_options(*part_, {.count = 0}, boundary, is_evened, "auto", levels(execution), execution);
  return tiling::ratio_without_poles(part_->surface, options, execution);
}

TilerPointer Tilers::tiler(const PoleChoice& poles, BoundaryLines boundary, bool is_evened, Execution& execution) {
  return tilers_.get({poles, boundary, is_evened}, [&] {
    const TilerPointer like = tilers_.any().value_or(nullptr);
    return std::make_shared<const Tiler>(part_, poles, boundary, is_evened, "auto", levels(execution), like.get(),
                                         execution);
  });
}

SeamlessPointer Tilers::tile(const TileOptions& options, Execution& execution) {
  return options.turns == 1 ? shifted(options, execution) : turned(options, execution);
}

SeamlessPointer Tilers::shifted(const TileOptions& options, Execution& execution) {
  const TilerPointer tiler = nested(execution, 0, kPlacing, [&] {
    return this->tiler(options.poles, options.boundary, options.evenness > 0, execution);
  });
  ShiftedKey key{tiler, options};
  key.second.evenness = 0;
  key.second.moves.clear();
  return nested(execution, kPlacing, 1, [&] {
    SeamlessPointer made = shifted_.get(key, [&] { return tiler->tile(options, execution); });
    if (made->evenness != options.evenness)
      shifted_.keep(key, made = tiler->evened(*made, options.evenness, execution));
    return options.moves.empty() ? made : tiler->moved(*made, options.moves, made->evenness, execution);
  });
}

std::shared_ptr<tiling::TurnedTiler> Tilers::turned_tiler(const TileOptions& options, Execution& execution) {
  check_turned(options);
  const Heading& heading = options.heading;
  return turned_.get({options.turns, options.rows, heading, options.marked, options.missing}, [&] {
    tiling::TilerOptions asked{
        options.turns, {}, part_->up, options.rows, options.marked, options.missing.value_or(std::vector<int>())};
    asked.levels = levels(execution);
    if (heading.is_upright() && part_->has_positions()) asked.along = {up_vector(part_->up), false};
    if (heading.kind == Heading::Kind::kVector) asked.along = {heading.vector, true};
    return std::make_shared<tiling::TurnedTiler>(part_->surface, asked, execution);
  });
}

double Tilers::guess_turned(const TileOptions& options, Execution& execution) {
  return turned_tiler(options, execution)->guess(options.tiles, execution);
}

SeamlessPointer Tilers::turned(const TileOptions& options, Execution& execution) {
  const std::shared_ptr<tiling::TurnedTiler> tiler = turned_tiler(options, execution);
  const SeamlessPointer made = turned_maps_.get({tiler, options.tiles, options.evenness}, [&] {
    return nested(execution, 0, 1, [&] {
      return turned_tiling(*tiler, *part_, options.turns, options.tiles, options.evenness, execution);
    });
  });
  check_added(*made, options.max_added, part_->type.genus);
  return made;
}

}  // namespace holomorph::choice
