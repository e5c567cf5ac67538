#include "tiling/placement.h"

#include "tiling/poles/pole_placement.h"
#include "uv/balance.h"

namespace holomorph::tiling {
namespace {

// Transfers the form from the level to the surface: the same residues, and the c_j with which it fits best as a vector
// field in space. Then both are optimised on the surface.
// @param greens of the level; afterwards of the surface
MeromorphicForm transferred(MeromorphicForm form, GreensFunctions& greens, const CoarseLevel& level,
                            std::shared_ptr<const mesh::Surface> surface, uv::Coefficients kind,
                            const PoleOptions& options, const Placement* like, Execution& execution) {
  const VectorXcd wanted = samples_of(form, greens);
  const MatrixXcd frames = uv::tangent_frames(*level.surface, greens.basis().samples());
  for (int& v : form.poles) v = level.vertex[v];
  const bool is_whole = level.is_whole(*surface);
  std::shared_ptr<const PoleBasis> own;
  if (like)
    own = like->basis;
  else if (is_whole)
    own = std::make_shared<const PoleBasis>(std::move(surface), options.solving, execution);
  else
    own =
        std::make_shared<const PoleBasis>(std::move(surface), options.solving, greens.shared_basis(), level, execution);
  greens = is_whole ? GreensFunctions(std::move(own)) : std::move(greens).on(std::move(own));
  const PoleBasis& basis = greens.basis();
  greens.solve_at(form.poles, execution);
  if (basis.form_count() > 0) {
    form.coefficients =
        fitted_coefficients(wanted, frames, basis.holomorphic().M, greens.at(form.poles) * form.residues,
                            uv::tangent_frames(basis.surface(), basis.samples()), kind == uv::Coefficients::real);
  }
  return optimised(greens, kind, std::move(form), execution);
}

// Makes the placement. It keeps the Green's functions of the poles alone, and drops those of the search.
Placement placement(PoleOptions options, uv::Coefficients kind, const GreensFunctions& greens, MeromorphicForm form,
                    PlacementStart start, const Placement* like, Execution& execution) {
  const auto& basis = greens.shared_basis();
  const double ratio = density_ratio(density(form, greens));
  Placement result{std::move(options), basis, kind, GreensFunctions(basis), std::move(form), ratio, std::move(start)};
  if (basis->has_jacobian())
    result.inversion = like ? like->inversion : std::make_shared<const JacobiInversion>(*basis, execution);
  result.greens.solve_at(result.form.poles, execution);
  return result;
}

PlacementStart started(const std::shared_ptr<const mesh::Surface>& surface, const PoleOptions& options,
                       Execution& execution) {
  execution.stage("level for the poles", 0.0, 0.2);
  CoarseLevel level = options.is_chosen() ? CoarseLevel{surface, {}, {}} : coarse_level(surface, execution);
  execution.stage("forms for the poles", 0.2, 0.25);
  auto basis = std::make_shared<const PoleBasis>(level.surface, options.solving, execution);
  return {std::move(level), std::move(basis), std::make_shared<BalancedForm>()};
}

// Whether another placement begins with the same.
bool is_alike(const Placement& other, const mesh::Surface& surface, const PoleOptions& options, uv::Coefficients kind) {
  return other.basis->structure().surface.get() == &surface && other.kind == kind &&
         other.options.solving.solver == options.solving.solver && !other.options.is_chosen() && !options.is_chosen();
}

}  // namespace

Placement place(std::shared_ptr<const mesh::Surface> surface, PoleOptions options, Execution& execution,
                const Placement* like) {
  const auto type = mesh::topological_type(*surface);
  const bool straight = !type.closed() && (options.straight || type.genus > 0);
  const auto kind = straight ? uv::Coefficients::real : uv::Coefficients::complex;
  if (like && !is_alike(*like, *surface, options, kind)) like = nullptr;
  PlacementStart start = like ? like->start : started(surface, options, execution);
  const CoarseLevel& level = start.level;
  GreensFunctions greens(start.basis);
  PlaceOptions place_options{kind, {}, options.vertices, level.large_polygons, options.evened, start.balanced};
  // Where poles are allowed, in the numbers of the level.
  for (const int v : level.vertex) {
    if (!options.allowed.empty()) place_options.allowed.push_back(options.allowed[v]);
  }
  execution.stage("search for poles", 0.25, 0.6);
  MeromorphicForm form = options.count ? placed_poles(greens, place_options, *options.count, execution)
                                       : placed_poles(greens, place_options, execution);
  execution.stage("forms of the surface", 0.6, 1.0);
  if (level.surface != surface)
    form = transferred(std::move(form), greens, level, surface, kind, options, like, execution);
  Placement result = placement(std::move(options), kind, greens, std::move(form), std::move(start), like, execution);
  execution.finish();
  return result;
}

std::shared_ptr<const SeamlessMaps> maps_at(const Placement& placement, const std::vector<int>& poles,
                                            Execution& execution) {
  return placement.maps->get(poles, [&] {
    const Execution::Within within(execution);
    return std::make_shared<SeamlessMaps>(placement.basis, placement.kind == uv::Coefficients::real, poles,
                                          placement.options.labels, placement.options.solving, execution);
  });
}

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

}  // namespace holomorph::tiling
