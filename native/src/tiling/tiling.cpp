#include "tiling/tiling.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/errors.h"
#include "tiling/rounding/rounding_problem.h"
#include "uv/vector_fields.h"

namespace holomorph::tiling {
namespace {

constexpr double kReach = 0.05;     // how far poles are expected to move, in square roots of the area
constexpr double kFollowing = 0.1;  // likewise, how far those may go that follow one that is moved
constexpr double kLeastTiles = 100, kTilesPerHandle = 64;
constexpr double kMoreTiles = 1.5, kMostTiles = 1e6;

std::string text(double number) {
  std::ostringstream out;
  out.precision(3);
  out << number;
  return out.str();
}

// Names the fewest tiles for which there is a rounding.
[[noreturn]] void refuse(RoundingProblem problem, const RoundingOptions& options, double tiles, Execution& execution) {
  const std::string asked = text(tiles);
  do {
    tiles *= kMoreTiles;
    problem.median_density *= kMoreTiles;
  } while (tiles < kMostTiles && roundings(problem, options, execution).empty());
  throw TopologyError("with " + asked + " tiles no seamless map of this surface is even; " + text(tiles) +
                      " are enough");
}

std::shared_ptr<const SeamlessMaps> maps_at(const Placement& placement, const std::vector<int>& poles,
                                            Execution& execution) {
  return placement.maps->get(poles, [&] {
    const Execution::Within within(execution);
    return std::make_shared<SeamlessMaps>(placement.basis, placement.kind == uv::Coefficients::real, poles,
                                          placement.options.labels, placement.options.solving, execution);
  });
}

// @throws TopologyError for poles that do not fit
LiftedPoles lifted_poles(const Placement& placement, Execution& execution) {
  LiftedPoles lifted{placement.form.poles, std::vector<VectorXd>(placement.form.poles.size())};
  if (placement.inversion) {
    for (std::size_t i = 0; i < lifted.parts.size(); ++i)
      lifted.parts[i] = placement.inversion->abel_jacobi.at(lifted.vertices[i]);
  } else if (!lifted.parts.empty()) {
    const auto maps = maps_at(placement, lifted.vertices, execution);
    const MatrixXd& parts = maps->pole_parts();
    for (Index i = 0; i < parts.cols(); ++i) lifted.parts[i] = parts.col(i);
  }
  return lifted;
}

// #natural x #free residues: the harmonic parts; closed, each against the last pole's.
MatrixXd parts_of(const LiftedPoles& poles, const PoleBasis& basis) {
  const auto count = static_cast<Index>(poles.parts.size());
  MatrixXd C(basis.structure().topology.families.natural, basis.closed() ? std::max<Index>(0, count - 1) : count);
  for (Index i = 0; i < C.cols(); ++i) {
    C.col(i) = poles.parts[i];
    if (basis.closed()) C.col(i) -= poles.parts.back();
  }
  return C;
}

RoundingOptions rounding_options(const Placement& placement, const TilingOptions& options) {
  RoundingOptions result;
  result.phase = options.turn;
  result.max_turn = options.max_turn;
  if (options.direction) {
    const PoleBasis& basis = *placement.basis;
    result.phase = phase_along(*options.direction, uv::tangent_frames(basis.surface(), basis.samples()),
                               samples_of(placement.form, placement.greens));
    if (result.phase) *result.phase += options.turn.value_or(0);
  }
  return result;
}

Tiling tiling_of(const Placement& placement, RoundedForm form, Execution& execution) {
  Tiling result;
  const Candidate& candidate = form.candidate;
  for (const Index i : candidate.used()) {
    result.poles.push_back(candidate.poles.vertices[i]);
    result.residues.push_back(candidate.residues[i]);
  }
  result.distortion = candidate.rounding.distortion;
  if (const Index defects = form.problem->defects.cols(); defects > 0) {
    const VectorXcd t = candidate.rounding.y.tail(defects);
    result.beltrami_rms = (defect_metric(*form.problem) * t).norm() / std::sqrt(form.tiles);
  }
  result.form = std::make_shared<const RoundedForm>(std::move(form));
  const VectorXcd residues = Eigen::Map<const VectorXcd>(result.residues.data(), std::ssize(result.residues));
  const auto maps = maps_at(placement, result.poles, execution);
  const SeamlessForm seamless = maps->form(result.form->candidate.X, residues, result.form->lattice);
  uv::UvArray function = maps->function(seamless, execution);
  execution.stage("UV map", 0.9, 1.0);
  result.structure = maps->structure();
  result.periods = seamless.periods;
  result.uv = seamless_uv(*result.structure, seamless, std::move(function), execution);
  execution.finish();
  return result;
}

}  // namespace

Tiling tile(const Placement& placement, const TilingOptions& options, Execution& execution) {
  execution.stage("rounding", 0.0, 0.4);
  const PoleBasis& basis = *placement.basis;
  const JacobiInversion* inversion = placement.inversion.get();
  const bool movable = !placement.options.is_chosen();
  const double usual = std::max(kLeastTiles, kTilesPerHandle * basis.structure().topology.type.genus);
  const double tiles = options.tiles > 0 ? options.tiles : usual;
  const LiftedPoles lifted = lifted_poles(placement, execution);
  RoundingProblem problem = rounding_problem(placement.form, placement.greens, placement.kind, options.lattice,
                                             parts_of(lifted, basis), inversion ? &inversion->jacobian : nullptr);
  problem.median_density = tiles / basis.area();
  if (inversion && movable && problem.residues.rows() > 0) {
    problem.repairable =
        kReach * kReach * basis.area() * inversion->reach(placement.form.poles, placement.form.residues);
  }
  const RoundingOptions rounding = rounding_options(placement, options);
  const std::vector<Rounding> list = roundings(problem, rounding, execution);
  if (list.empty()) refuse(std::move(problem), rounding, tiles, execution);
  Candidate best = best_candidate(problem, list, lifted, {inversion, movable, placement.options.allowed}, tiles,
                                  placement.greens, execution);
  execution.stage("poles at their places", 0.4, 0.9);
  RoundedForm form{options.lattice, tiles, std::make_shared<const RoundingProblem>(std::move(problem)),
                   std::move(best)};
  return tiling_of(placement, std::move(form), execution);
}

Tiling move_poles(const Placement& placement, RoundedForm form, const std::vector<PoleMove>& moves,
                  Execution& execution) {
  execution.stage("poles at their places", 0.0, 0.9);
  if (moves.empty()) return tiling_of(placement, std::move(form), execution);
  const PoleBasis& basis = *placement.basis;
  Candidate& candidate = form.candidate;
  const std::vector<char> moved = place_at(moves, basis, placement.options.labels, candidate);
  if (placement.inversion) {
    const bool stay = placement.options.is_chosen();
    const MoveOptions options{placement.options.allowed, kFollowing, stay ? std::vector<char>(moved.size(), 1) : moved};
    const MatrixXcd metric = defect_metric(*form.problem) / std::sqrt(form.tiles);
    follow_by_inversion(*placement.inversion, metric, options, moved, candidate);
  } else if (basis.form_count() > 0) {
    std::vector<int> vertices;
    for (const Index i : candidate.used()) vertices.push_back(candidate.poles.vertices[i]);
    follow_with_boundary(basis, *form.problem, maps_at(placement, vertices, execution)->pole_parts(), candidate);
  }
  GreensFunctions greens = placement.greens;
  greens.solve_at(candidate.poles.vertices, execution);
  measure(*form.problem, greens, candidate);
  return tiling_of(placement, std::move(form), execution);
}

}  // namespace holomorph::tiling
