#include "tiling/tiling.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "base/errors.h"
#include "linear/dense.h"
#include "tiling/inversion/abel_jacobi.h"
#include "tiling/maps/assemble.h"
#include "tiling/rounding/rounding.h"
#include "uv/balance.h"
#include "uv/evening.h"

namespace holomorph::tiling {
namespace {

// The rounding problem of a form with poles.

struct Sizes {
  Index n, loops, handles, k, l;  // `handles`: loops with v-periods besides, if boundary loops are straight
};

// Sets for each integer the period or residue that it belongs to, and the translation that it counts.
void set_integers(const TextureLattice& lattice, const Sizes& size, bool real, RoundingProblem& p) {
  const Index both = (real ? size.loops + size.handles : 2 * size.loops), D = both + (real ? 1 : 2) * size.k;
  p.periods = MatrixXcd::Zero(size.loops, D);
  p.residues = MatrixXcd::Zero(size.k, D);
  Index column = 0;
  for (Index j = 0; j < size.loops; ++j) {
    p.periods(j, column++) = lattice.a;
    if (!real || j < size.handles) p.periods(j, column++) = lattice.b;
  }
  for (Index i = 0; i < size.k; ++i) {
    p.residues(i, column++) = lattice.a;
    if (!real) p.residues(i, column++) = lattice.b;
  }
}

// A of the Dirichlet forms of the handles on the samples, up to the factor i. Forms of the loops, whose periods are
// free, are subtracted so that the energy is least.
MatrixXcd handle_forms(const PoleBasis& basis, const Sizes& size) {
  if (size.handles == 0) return MatrixXcd(static_cast<Index>(basis.samples().size()), 0);
  const MatrixXd& G = basis.structure().holomorphic().star.dirichlet_gram;
  const Index holes = size.n - size.handles;
  MatrixXd q = MatrixXd::Zero(size.n, size.handles);
  q.topRows(size.handles).setIdentity();
  if (holes > 0)
    q.bottomRows(holes) = -linear::solve_symmetric(MatrixXd(G.bottomRightCorner(holes, holes)),
                                                   MatrixXd(G.bottomLeftCorner(holes, size.handles)));
  return 0.5 * basis.derivatives(basis.samples()).rightCols(size.n) * q;
}

// X = n + i m + sum_i r_i C_i are the periods of a form besides its poles; n + i m and r_i are points of the lattice.
// * Closed: X = sum_j c_j theta_j + t_j conj(theta_j) in cohomology, g defects t.
// * With boundary, free loops (planar): c = X. No defects: every rounding is conformal.
// * With boundary, straight loops: c = Re X over all loops, r real; the defects are what the v-periods of the 2g
//   handles lack, t = Im(n + i m) - C#^T c, as multiples of the Dirichlet forms of the handles whose loop periods,
//   which are free, have least energy.
// @param parts #loops x k: C_i; closed: against the last pole, whose residue is the rest
// @param greens with those of the poles
// @param jacobian of a closed surface with handles, else null. @throws Cancelled
RoundingProblem rounding_problem(const MeromorphicForm& form, const GreensFunctions& greens, uv::Coefficients kind,
                                 const TextureLattice& lattice, const MatrixXd& parts, const Jacobian* jacobian,
                                 Execution& execution) {
  const PoleBasis& basis = greens.basis();
  const bool real = kind == uv::Coefficients::real, closed = basis.closed();
  const auto& topology = basis.structure().topology;
  Sizes size{basis.form_count(), topology.families.natural, real ? 2 * topology.type.genus : 0, parts.cols(), 0};
  size.l = closed ? size.n : size.handles;
  RoundingProblem p;
  p.kind = kind;
  p.lattice = lattice;
  set_integers(lattice, size, real, p);

  const MatrixXcd at_poles = greens.pole_forms(form.poles);
  p.forms.resize(at_poles.rows(), size.n + size.k + size.l);
  p.target = VectorXcd::Zero(p.forms.cols());
  p.target.head(size.n) = form.coefficients;
  p.target.segment(size.n, size.k) = form.residues.head(size.k);

  // Columns: X and the residues for each integer. Z takes the integers on to coefficients.
  const MatrixXcd X = p.periods + parts * p.residues;
  p.Z = MatrixXcd::Zero(p.forms.cols(), p.periods.cols());
  p.Z.middleRows(size.n, size.k) = p.residues;
  if (closed) {
    // theta = M dz + N d conj(z), so conj(theta) has A = conj(N) and B = conj(M).
    p.forms << basis.holomorphic().M, at_poles, basis.holomorphic().N.conjugate();
    p.defects = basis.holomorphic().M.conjugate();
    if (jacobian) {
      const MatrixXcd split = product(jacobian->split(), X, execution);
      p.Z.topRows(size.n) = split.topRows(size.n);
      p.Z.bottomRows(size.l) = split.bottomRows(size.l);
    }
  } else {
    const MatrixXcd of_handles = handle_forms(basis, size);
    // A real form is A dz + conj(A) d conj(z), and v enters with i.
    p.forms << basis.holomorphic().M, at_poles, Complex(0, 1) * of_handles;
    p.defects = Complex(0, 1) * of_handles.conjugate();
    p.Z.topRows(size.n) = real ? MatrixXcd(X.real().cast<Complex>()) : X;
    const MatrixXd& star = basis.structure().holomorphic().star.star;
    if (size.l > 0) {
      p.Z.bottomRows(size.l) =
          (p.periods.topRows(size.l).imag() - (star.transpose() * X.real()).topRows(size.l)).cast<Complex>();
    }
  }
  p.target_density = (p.forms * p.target).cwiseAbs2().array();
  p.target_ratio = density_ratio(p.target_density);
  p.defect_metric = defect_metric(p.defects, p.target_density, execution);
  return p;
}

constexpr double kSizeThatCounts = 1;  // RoundingProblem::size_weight where the wanted size counts
constexpr double kReach = 0.05;        // how far poles are expected to move, in square roots of the area
constexpr double kLeastTiles = 100, kTilesPerHandle = 64;  // the usual number of tiles
constexpr double kMoreTiles = 1.5, kMostTiles = 1e6;       // factor and end of the search for a number that is enough

std::string text(double number) {
  std::ostringstream out;
  out.precision(3);
  out << number;
  return out.str();
}

// Throws. The message names a number of tiles, a power of 1.5 larger, for which there is a rounding. The reduced
// lattices of the search serve all numbers.
[[noreturn]] void refuse(RoundingProblem& problem, const RoundingSearch& search) {
  const std::string asked = text(problem.tiles);
  do {
    problem.tiles *= kMoreTiles;
    problem.median_density *= kMoreTiles;
  } while (problem.tiles < kMostTiles && search.best().empty());
  throw TopologyError("with " + asked + " tiles no seamless map of this surface is even; " + text(problem.tiles) +
                      " are enough");
}

// Returns the harmonic parts, #natural x #free residues; on a closed surface each minus that of the last pole.
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
  result.steps = options.size_counts;
  if (options.direction) {
    const PoleBasis& basis = *placement.basis;
    result.phase = phase_along(*options.direction, uv::tangent_frames(basis.surface(), basis.samples()),
                               samples_of(placement.form, placement.greens));
    if (result.phase) *result.phase += options.turn.value_or(0);
  }
  return result;
}

ConformalTiling conformal_tiling(const Placement& placement, RoundedForm form, Execution& execution) {
  ConformalTiling result;
  for (const Index i : form.candidate.used()) {
    result.poles.push_back(form.candidate.poles.vertices[i]);
    result.residues.push_back(form.candidate.residues[i]);
  }
  const RoundingProblem& problem = *form.problem;
  const Rounding& rounding = form.candidate.rounding;
  result.distortion = rounding.distortion;
  if (const Index defects = problem.defects.cols(); defects > 0)
    result.beltrami_rms = (problem.defect_metric * rounding.y.tail(defects)).norm() / std::sqrt(problem.tiles);
  const VectorXcd residues = Eigen::Map<const VectorXcd>(result.residues.data(), std::ssize(result.residues));
  const auto maps = maps_at(placement, result.poles, execution);
  result.seamless = maps->form(form.candidate.X, residues, problem.lattice);
  result.function = maps->function(result.seamless, execution);
  result.structure = maps->structure();
  result.straight = placement.kind == uv::Coefficients::real;
  result.form = std::move(form);
  return result;
}

std::vector<int> boundary_vertices(const mesh::Surface& surface) {
  std::vector<char> marked(surface.vertex_count, 0);
  for (std::size_t e = 0; e < surface.edges.size(); ++e) {
    if (surface.edge_face_count[e] == 1) marked[surface.edges[e][0]] = marked[surface.edges[e][1]] = 1;
  }
  std::vector<int> vertices;
  for (int v = 0; v < surface.vertex_count; ++v) {
    if (marked[v]) vertices.push_back(v);
  }
  return vertices;
}

// Evens the tiling and makes its UVs: the rest of the stages, from the fraction `begin` on.
Tiling with_evenness(std::shared_ptr<const ConformalTiling> conformal, double evenness, double begin,
                     Execution& execution) {
  const mesh::Surface& surface = *conformal->structure->surface;
  uv::UvArray function = conformal->function;
  if (evenness > 0) {
    execution.stage("evening", begin, 0.9);
    uv::Kept kept{conformal->poles, {}, {}, {}, {}};
    if (conformal->straight) kept.v = boundary_vertices(surface);
    // Evening adds a function on the vertices, so that jumps and straight boundaries stay.
    uv::UvArray uv = seamless_uv(*conformal->structure, conformal->seamless, function, execution);
    function += uv::evened(surface, std::move(uv), kept, evenness, execution);
  }
  execution.stage("UV map", 0.9, 1.0);
  Tiling result{conformal, evenness, {}};
  result.uv = seamless_uv(*conformal->structure, conformal->seamless, std::move(function), execution);
  execution.finish();
  return result;
}

}  // namespace

Tiling tile(const Placement& placement, const TilingOptions& options, Execution& execution) {
  execution.stage("rounding", 0.0, 0.4);
  const PoleBasis& basis = *placement.basis;
  const JacobiInversion* inversion = placement.inversion.get();
  const LiftedPoles lifted = lifted_poles(placement, execution);
  RoundingProblem problem =
      rounding_problem(placement.form, placement.greens, placement.kind, options.lattice, parts_of(lifted, basis),
                       inversion ? &inversion->jacobian : nullptr, execution);
  const double usual = std::max(kLeastTiles, kTilesPerHandle * basis.structure().topology.type.genus);
  problem.tiles = options.tiles > 0 ? options.tiles : usual;
  problem.median_density = problem.tiles / basis.area();
  if (options.size_counts) problem.size_weight = kSizeThatCounts;
  if (inversion && !placement.options.is_chosen() && problem.residues.rows() > 0) {
    // Defects that poles can cancel by moving about kReach cost little in the rounding.
    problem.repairable =
        kReach * kReach * basis.area() * inversion->reach(placement.form.poles, placement.form.residues);
  }
  const RoundingSearch search(problem, rounding_options(placement, options), execution);
  const std::vector<Rounding> list = search.best();
  if (list.empty()) refuse(problem, search);
  Candidate best = best_candidate(placement, problem, list, lifted, execution);
  execution.stage("poles at their places", 0.4, 0.6);
  RoundedForm form{std::make_shared<const RoundingProblem>(std::move(problem)), std::move(best), search.record()};
  auto conformal = std::make_shared<const ConformalTiling>(conformal_tiling(placement, std::move(form), execution));
  return with_evenness(std::move(conformal), options.evenness, 0.6, execution);
}

Tiling move_poles(const Placement& placement, const Tiling& tiling, const std::vector<PoleMove>& moves, double evenness,
                  Execution& execution) {
  execution.stage("poles at their places", 0.0, 0.6);
  RoundedForm form = tiling.conformal->form;
  if (!moves.empty())
    form.candidate = with_poles_moved(placement, *form.problem, moves, std::move(form.candidate), execution);
  auto conformal = std::make_shared<const ConformalTiling>(conformal_tiling(placement, std::move(form), execution));
  return with_evenness(std::move(conformal), evenness, 0.6, execution);
}

Tiling evened(const Tiling& tiling, double evenness, Execution& execution) {
  return with_evenness(tiling.conformal, evenness, 0.0, execution);
}

uv::Quality quality(const Tiling& tiling, std::optional<uv::Up> up, Execution& execution) {
  const mesh::Surface& surface = *tiling.conformal->structure->surface;
  uv::Quality result = uv::quality(surface, tiling.uv, execution.workers());
  if (up) result.direction = uv::direction(surface, tiling.uv, *up, 1, execution.workers());
  if (tiling.evenness > 0) {
    const uv::UvArray conformal = evened(tiling, 0, execution).uv;
    uv::set_evened_from(result, uv::quality(surface, conformal, execution.workers()), tiling.evenness);
  }
  return result;
}

}  // namespace holomorph::tiling
