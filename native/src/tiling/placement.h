// Places the poles of seamless tilings.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "base/resource_pool.h"
#include "structure/solver_report.h"
#include "tiling/inversion/abel_jacobi.h"
#include "tiling/maps/assemble.h"
#include "tiling/poles/meromorphic_form.h"
#include "tiling/poles/pole_candidates.h"

namespace holomorph::tiling {

// Jacobi inversion: moves the poles of a form until it is holomorphic although its periods are integers.

/// Poles at vertices. C there is known modulo integers; `parts` are the representatives that the periods refer to.
struct LiftedPoles {
  std::vector<int> vertices;
  std::vector<VectorXd> parts;  ///< C at each, 2g
};

struct MoveOptions {
  std::vector<char> allowed;   ///< #V, empty: anywhere
  double farthest = 0.12;      ///< how far a pole may go, in square roots of the area
  std::vector<char> held;      ///< #poles, 1 for poles that stay at their vertices; empty: none
  std::function<void()> tick;  ///< called for each step; it may throw
};

/// Moves the poles of a closed surface with handles.
struct JacobiInversion {
  /// @pre the basis outlives this. @throws Cancelled
  JacobiInversion(const PoleBasis& surface, Execution& execution)
      : basis(surface), abel_jacobi(surface, execution), jacobian(surface) {}

  const PoleBasis& basis;
  const AbelJacobi abel_jacobi;
  const Jacobian jacobian;

  /// Returns the covariance, g x g, of the t that moving these poles by about 1 can cancel.
  MatrixXcd reach(const std::vector<int>& vertices, const VectorXcd& residues) const;

  /// Moves the poles anywhere on the surface by Newton's method until t vanishes, or is as small as it becomes. Then
  /// places one pole after the other at its nearest vertex, the one that moves t most first, and lets the others
  /// follow. At last exchanges pairs of poles for better pairs of vertices near them.
  /// @param metric g x g, R with |R t| the rms Beltrami coefficient. @throws SolverError as AbelJacobi does
  LiftedPoles moved(LiftedPoles poles, const VectorXcd& periods, const VectorXcd& residues, const MatrixXcd& metric,
                    const MoveOptions& options) const;
};

struct PoleOptions {
  std::optional<int> count;    ///< number of poles; none: as many as the density asks for
  std::vector<int> vertices;   ///< chosen poles, which stay where they are
  std::vector<char> allowed;   ///< #V: where poles may be that are not chosen; empty: anywhere
  bool straight = true;        ///< boundary loops become lines of constant v; with handles they do in any case, since
                               ///< free ones would leave the map less conformal
  std::vector<int> labels;     ///< #V: what a vertex is called in messages; empty: its index
  structure::Options solving;  ///< how the linear systems are solved
  bool evened = false;         ///< tilings will be evened: then fewer poles are enough
  std::shared_ptr<const Levels> levels = nullptr;  ///< of the surface; null: its own

  bool is_chosen() const { return !vertices.empty(); }
};

/// What the search begins with, for any number of poles.
struct PlacementStart {
  CoarseLevel level;
  std::shared_ptr<const PoleBasis> basis;            ///< on the level
  std::shared_ptr<BalancedForm> balanced = nullptr;  ///< the form without poles, once it was needed
};

/// The poles of a surface, and all that tilings with them are made of. Several threads may use one.
struct Placement {
  PoleOptions options;
  std::shared_ptr<const PoleBasis> basis;  ///< on the surface
  uv::Coefficients kind;                   ///< real: straight loops
  GreensFunctions greens;                  ///< at the poles
  MeromorphicForm form;                    ///< the most even one with these poles, before its periods are rounded
  double optimal_density_ratio = 1;        ///< 95 % over 5 % quantile of its density
  PlacementStart start;
  std::shared_ptr<const JacobiInversion> inversion = nullptr;  ///< on a closed surface with handles, else null
  /// The maps of the last tiling, reused by the next one with the same poles.
  using KnownMaps = Newest<std::vector<int>, std::shared_ptr<const SeamlessMaps>>;
  std::shared_ptr<KnownMaps> maps = std::make_shared<KnownMaps>();
};

/// Places the poles, on a level of the progressive mesh where the surface is large (pole_placement.h).
/// @param like null, or a placement on the same surface, whose bases and balanced form are taken where they are the
/// same
/// @pre connected, no isolated vertices. @throws TopologyError for poles that do not fit; SolverError; Cancelled
Placement place(std::shared_ptr<const mesh::Surface> surface, PoleOptions options, Execution& execution,
                const Placement* like = nullptr);

/// The 95 % over 5 % quantile of the density of the most even form without poles, on a level of few triangles: about
/// that on the surface. @throws as `place`
double ratio_without_poles(const std::shared_ptr<const mesh::Surface>& surface, const PoleOptions& options,
                           Execution& execution);

/// Returns the seamless maps with poles at these vertices. @throws TopologyError for poles that do not fit;
/// SolverError; Cancelled
std::shared_ptr<const SeamlessMaps> maps_at(const Placement& placement, const std::vector<int>& poles,
                                            Execution& execution);

/// Returns the placed poles and their harmonic parts. The same errors.
LiftedPoles lifted_poles(const Placement& placement, Execution& execution);

}  // namespace holomorph::tiling
