#include "tiling/tiling.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/errors.h"
#include "tiling/rounding/rounding_problem.h"
#include "uv/vector_fields.h"

namespace holomorph::tiling {
namespace {

constexpr double kReach = 0.05;  // how far poles are expected to move, in square roots of the area
constexpr double kLeastTiles = 100, kTilesPerHandle = 64;
constexpr double kMoreTiles = 1.5, kMostTiles = 1e6;

std::string text(double number) {
  std::ostringstream out;
  out.precision(3);
  out << number;
  return out.str();
}

// Names the fewest tiles for which there is a rounding.
[[noreturn]] void refuse(RoundingProblem problem, const RoundingOptions& options, Execution& execution) {
  const std::string asked = text(problem.tiles);
  do {
    problem.tiles *= kMoreTiles;
    problem.median_density *= kMoreTiles;
  } while (problem.tiles < kMostTiles && roundings(problem, options, execution).empty());
  throw TopologyError("with " + asked + " tiles no seamless map of this surface is even; " + text(problem.tiles) +
                      " are enough");
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
  const RoundingProblem& problem = *form.problem;
  for (const Index i : form.candidate.used()) {
    result.poles.push_back(form.candidate.poles.vertices[i]);
    result.residues.push_back(form.candidate.residues[i]);
  }
  const Rounding& rounding = form.candidate.rounding;
  result.distortion = rounding.distortion;
  if (const Index defects = problem.defects.cols(); defects > 0)
    result.beltrami_rms = (defect_metric(problem) * rounding.y.tail(defects)).norm() / std::sqrt(problem.tiles);
  const VectorXcd residues = Eigen::Map<const VectorXcd>(result.residues.data(), std::ssize(result.residues));
  const auto maps = maps_at(placement, result.poles, execution);
  const SeamlessForm seamless = maps->form(form.candidate.X, residues, problem.lattice);
  uv::UvArray function = maps->function(seamless, execution);
  execution.stage("UV map", 0.9, 1.0);
  result.form = std::make_shared<const RoundedForm>(std::move(form));
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
  const LiftedPoles lifted = lifted_poles(placement, execution);
  RoundingProblem problem = rounding_problem(placement.form, placement.greens, placement.kind, options.lattice,
                                             parts_of(lifted, basis), inversion ? &inversion->jacobian : nullptr);
  const double usual = std::max(kLeastTiles, kTilesPerHandle * basis.structure().topology.type.genus);
  problem.tiles = options.tiles > 0 ? options.tiles : usual;
  problem.median_density = problem.tiles / basis.area();
  if (inversion && !placement.options.is_chosen() && problem.residues.rows() > 0) {
    problem.repairable =
        kReach * kReach * basis.area() * inversion->reach(placement.form.poles, placement.form.residues);
  }
  const RoundingOptions rounding = rounding_options(placement, options);
  const std::vector<Rounding> list = roundings(problem, rounding, execution);
  if (list.empty()) refuse(std::move(problem), rounding, execution);
  Candidate best = best_candidate(placement, problem, list, lifted, execution);
  execution.stage("poles at their places", 0.4, 0.9);
  return tiling_of(placement, {std::make_shared<const RoundingProblem>(std::move(problem)), std::move(best)},
                   execution);
}

Tiling move_poles(const Placement& placement, RoundedForm form, const std::vector<PoleMove>& moves,
                  Execution& execution) {
  execution.stage("poles at their places", 0.0, 0.9);
  if (!moves.empty())
    form.candidate = with_poles_moved(placement, *form.problem, moves, std::move(form.candidate), execution);
  return tiling_of(placement, std::move(form), execution);
}

}  // namespace holomorph::tiling
