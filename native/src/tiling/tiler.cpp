#include "tiling/tiler.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/errors.h"
#include "structure/pole_structure.h"
#include "tiling/flow.h"
#include "tiling/pole_placement.h"
#include "tiling/seamless_map.h"
#include "tiling/tiling_problem.h"
#include "uv/vector_fields.h"

namespace holomorph::tiling {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;

constexpr double kReach = 0.05;  // how far poles are expected to move, in square roots of the area
constexpr double kLeastTiles = 100, kTilesPerHandle = 64;
constexpr double kMoreTiles = 1.5, kMostTiles = 1e6;
constexpr double kMakeUp = 0.1;  // likewise, for those that make up for one that is moved

std::string text(double number) {
  std::ostringstream out;
  out.precision(3);
  out << number;
  return out.str();
}

// The rounding with the fewest tiles that there is, for the message.
[[noreturn]] void refuse(RoundingProblem problem, const RoundingWishes& wishes, double tiles, Execution& execution) {
  const std::string wished = text(tiles);
  do {
    tiles *= kMoreTiles;
    problem.median_density *= kMoreTiles;
  } while (tiles < kMostTiles && roundings(problem, wishes, execution).empty());
  throw TopologyError("with " + wished + " tiles no seamless map of this surface is even; " + text(tiles) +
                      " are enough");
}

void finish_map(Tiling& result, const SeamlessForm& form, uv::UvArray function, Execution& execution) {
  execution.stage("UV map", 0.9, 1.0);
  result.periods = form.periods;
  result.uv = seamless_uv(*result.structure, form, std::move(function), execution);
}

}  // namespace

Tiler::Tiler(std::shared_ptr<const mesh::Surface> surface, const structure::Options& options, bool straight,
             std::vector<int> names)
    : surface_(std::move(surface)), options_(options), names_(std::move(names)) {
  const auto type = mesh::topological_type(*surface_);
  kind_ = !type.closed() && (straight || type.genus > 0) ? uv::Coefficients::real : uv::Coefficients::complex;
}

void Tiler::place(const PoleWishes& wishes, Execution& execution) {
  chosen_ = !wishes.vertices.empty();
  allowed_ = wishes.allowed;
  execution.stage("level for the poles", 0.0, 0.2);
  const CoarseLevel level = chosen_ ? CoarseLevel{surface_, {}, {}} : coarse_level(surface_, execution);
  execution.stage("forms for the poles", 0.2, 0.25);
  auto landscape = std::make_unique<Landscape>(level.surface, options_, execution);
  PlacementRules rules{kind_, {}, wishes.vertices, level.large_polygons};
  for (const int v : level.vertex) {
    if (!wishes.allowed.empty()) rules.allowed.push_back(wishes.allowed[v]);
  }
  execution.stage("poles", 0.25, 0.6);
  Poles poles = wishes.count ? placed_poles(*landscape, rules, *wishes.count, execution)
                             : placed_poles(*landscape, rules, execution);
  execution.stage("forms of the surface", 0.6, 1.0);
  if (level.surface == surface_)
    adopt(std::move(landscape), std::move(poles), execution);
  else
    transfer(std::move(landscape), level, std::move(poles), execution);
  landscape_->forget_poles();
  execution.finish();
}

void Tiler::adopt(std::unique_ptr<Landscape> landscape, Poles poles, Execution& execution) {
  pole_moves_.reset();
  abel_jacobi_.reset();
  last_.reset();
  structure_.reset();
  closed_maps_.reset();
  landscape_ = std::move(landscape);
  poles_ = std::move(poles);
  optimum_ = density_ratio(density(*landscape_, poles_, execution));
  if (landscape_->closed() && landscape_->form_count() > 0) {
    abel_jacobi_ = std::make_unique<AbelJacobi>(*landscape_, execution);
    pole_moves_ = std::make_unique<PoleMoves>(*landscape_, *abel_jacobi_);
  }
}

// The same form on the surface: the same residues, and c_j that fit it as a vector field in space.
void Tiler::transfer(std::unique_ptr<Landscape> on_level, const CoarseLevel& level, Poles poles, Execution& execution) {
  const VectorXcd wanted =
      on_level->holomorphic().M * poles.coefficients + on_level->poles(poles.vertices, execution) * poles.residues;
  const MatrixXcd frames = uv::tangent_frames(on_level->surface(), on_level->samples());
  for (int& v : poles.vertices) v = level.vertex[v];
  auto landscape = level.is_whole(*surface_)
                       ? std::make_unique<Landscape>(surface_, options_, execution)
                       : std::make_unique<Landscape>(surface_, options_, std::move(on_level), level, execution);
  if (landscape->form_count() > 0) {
    poles.coefficients = fitted_coefficients(
        wanted, frames, landscape->holomorphic().M, landscape->poles(poles.vertices, execution) * poles.residues,
        uv::tangent_frames(*surface_, landscape->samples()), kind_ == uv::Coefficients::real);
  }
  poles = optimised(*landscape, {kind_, {}, {}}, std::move(poles), execution);
  adopt(std::move(landscape), std::move(poles), execution);
}

std::shared_ptr<structure::Structure> Tiler::structure_at(const std::vector<int>& vertices, Execution& execution) {
  if (structure_ && structure_poles_ == vertices) return structure_;
  if (vertices.empty()) {
    structure_ = std::make_shared<structure::Structure>(landscape_->structure());
  } else {
    structure::Poles poles{vertices, std::vector<Complex>(vertices.size(), 1.0), names_};
    if (landscape_->closed()) poles.residues.back() = -static_cast<double>(vertices.size() - 1);
    const Execution::Within within(execution);
    structure_ = std::make_shared<structure::Structure>(
        structure::pole_structure(surface_, std::move(poles), options_, execution));
  }
  structure_poles_ = vertices;
  return structure_;
}

// The harmonic parts C of the pole forms in the classes of the landscape; where poles can move, those of each pole
// besides.
MatrixXd Tiler::parts(PlacedPoles& placed, Execution& execution) {
  if (!has_leverage()) {
    const auto s = structure_at(poles_.vertices, execution);
    if (!s->poles) return MatrixXd(s->topology.families.natural, 0);
    const MatrixXd& C = s->poles->harmonic_part;
    if (C.size() == 0) return C;
    return change_of_basis(landscape_->structure().topology.classes, *s).inverse() * C;
  }
  for (const int v : poles_.vertices) placed.parts.push_back(abel_jacobi_->at(v));
  const Index k = std::max<Index>(0, static_cast<Index>(placed.parts.size()) - 1);
  MatrixXd result(landscape_->structure().topology.families.natural, k);
  for (Index i = 0; i < k; ++i) result.col(i) = placed.parts[i] - placed.parts.back();
  return result;
}

RoundingWishes Tiler::rounding_wishes(const TilingWishes& wishes, Execution& execution) {
  RoundingWishes result;
  result.phase = wishes.turn;
  result.turn = wishes.most_turn;
  if (wishes.direction) {
    const VectorXcd A = landscape_->holomorphic().M * poles_.coefficients +
                        landscape_->poles(poles_.vertices, execution) * poles_.residues;
    result.phase = phase_along(*wishes.direction, uv::tangent_frames(*surface_, landscape_->samples()), A);
    if (result.phase) *result.phase += wishes.turn.value_or(0);
  }
  return result;
}

Tiling Tiler::tile(const TilingWishes& wishes, Execution& execution) {
  execution.stage("rounding", 0.0, 0.4);
  const double usual = std::max(kLeastTiles, kTilesPerHandle * landscape_->structure().topology.type.genus);
  const double tiles = wishes.tiles > 0 ? wishes.tiles : usual;
  PlacedPoles placed{poles_.vertices, {}};
  const MatrixXd C = parts(placed, execution);
  const Leverage* leverage = has_leverage() ? &pole_moves_->leverage() : nullptr;
  RoundingProblem problem = tiling_problem(*landscape_, poles_, kind_, wishes.lattice, C, leverage, execution);
  problem.median_density = tiles / landscape_->area();
  if (leverage && !chosen_ && C.cols() > 0)
    problem.repairable = kReach * kReach * landscape_->area() * pole_moves_->reach(poles_.vertices, poles_.residues);
  const RoundingWishes rounding = rounding_wishes(wishes, execution);
  const std::vector<Rounding> list = roundings(problem, rounding, execution);
  if (list.empty()) refuse(std::move(problem), rounding, tiles, execution);
  Candidate chosen =
      best_candidate(problem, list, placed, {pole_moves_.get(), !chosen_, allowed_}, tiles, *landscape_, execution);
  last_ = {std::move(chosen), std::move(problem), C, wishes.lattice, tiles};
  execution.stage("poles at their places", 0.4, 0.9);
  return map_of(last_->candidate, execution);
}

Tiling Tiler::map_of(const Candidate& candidate, Execution& execution) {
  Tiling result;
  for (const Index i : candidate.used()) {
    result.poles.push_back(candidate.poles.vertices[i]);
    result.residues.push_back(candidate.residues[i]);
  }
  write_map(result, candidate.X, last_->lattice, execution);
  result.tiles = last_->tiles;
  result.distortion = candidate.rounding.distortion;
  if (const Index defects = last_->problem.defects.cols(); defects > 0) {
    const VectorXcd t = candidate.rounding.y.tail(defects);
    result.left_over = (defect_metric(last_->problem) * t).norm() / std::sqrt(result.tiles);
  }
  execution.finish();
  return result;
}

Tiling Tiler::with_poles_moved(const std::vector<PoleMove>& moves, Execution& execution) {
  execution.stage("poles at their places", 0.0, 0.9);
  if (moves.empty()) return map_of(last_->candidate, execution);
  Candidate candidate = last_->candidate;
  const std::vector<char> moved = put(moves, *landscape_, names_, candidate);
  const Index n = landscape_->form_count(), k = last_->problem.residues.rows();
  if (has_leverage()) {
    const std::vector<char> held = chosen_ ? std::vector<char>(moved.size(), 1) : moved;
    follow_with_leverage(*last_, *abel_jacobi_, *pole_moves_, {allowed_, kMakeUp, held}, moved, candidate);
  } else if (n > 0) {
    std::vector<int> vertices;
    for (const Index i : candidate.used()) vertices.push_back(candidate.poles.vertices[i]);
    const auto now = structure_at(vertices, execution);
    follow_with_boundary(*last_, *landscape_, *now, kind_ == uv::Coefficients::real, candidate);
  }
  RoundingProblem there = last_->problem;
  there.forms.middleCols(n, k) = pole_forms(*landscape_, candidate.poles.vertices, execution);
  measure(there, candidate.rounding);
  return map_of(candidate, execution);
}

void Tiler::write_map(Tiling& result, const VectorXcd& X, const TextureLattice& lattice, Execution& execution) {
  const auto count = static_cast<Index>(result.residues.size());
  const VectorXcd all = Eigen::Map<const VectorXcd>(result.residues.data(), count);
  if (landscape_->closed() && count > 0) {
    auto within = std::make_optional<Execution::Within>(execution);
    if (!closed_maps_ || closed_maps_->vertices() != result.poles)
      closed_maps_ = std::make_shared<ClosedMaps>(*landscape_, result.poles, names_, options_, execution);
    const SeamlessForm form = closed_maps_->form(X, all.head(count - 1), lattice);
    result.structure = closed_maps_->structure();
    uv::UvArray function = closed_maps_->function(form, execution);
    within.reset();
    finish_map(result, form, std::move(function), execution);
    return;
  }
  const auto s = structure_at(result.poles, execution);
  const VectorXcd there = change_of_basis(landscape_->structure().topology.classes, *s) * X;
  const auto form = seamless_form(*s, there, all, lattice, kind_ == uv::Coefficients::real);
  result.structure = s;
  finish_map(result, form, function_of(*s, form, execution), execution);
}

}  // namespace holomorph::tiling
