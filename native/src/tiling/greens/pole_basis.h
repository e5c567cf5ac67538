// The basis of forms with poles: the holomorphic forms of a surface, and what solves for Green's functions, on samples
// spread over the area.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "base/held.h"
#include "base/resource_pool.h"
#include "structure/harmonic_solver.h"
#include "structure/options.h"
#include "structure/structure.h"
#include "tiling/greens/coarse_level.h"
#include "tiling/notation.h"
#include "uv/density_objective.h"

namespace holomorph::tiling {

/// Green's functions that are solved for at a time.
inline constexpr int kGreensBlock = 32;

/// Everything belongs to the surface's own triangles. Immutable: several threads may use one.
class PoleBasis {
 public:
  using Solver = ResourcePool<structure::HarmonicSolver>;

  /// @pre connected, no isolated vertices. @throws SolverError, Cancelled
  PoleBasis(std::shared_ptr<const mesh::Surface> surface, const structure::Options& options, Execution& execution);
  /// Samples a large surface where its coarse level is sampled, and uses the level's Green's functions.
  PoleBasis(std::shared_ptr<const mesh::Surface> surface, const structure::Options& options,
            std::shared_ptr<const PoleBasis> on_level, const CoarseLevel& level, Execution& execution);
  PoleBasis(const PoleBasis&) = delete;
  PoleBasis& operator=(const PoleBasis&) = delete;

  const mesh::Surface& surface() const { return *structure_.surface; }
  const mesh::Discretisation& discretisation() const { return discretisation_; }
  const mesh::HalfEdges& half_edges() const { return discretisation_.half_edges; }
  const Array<double>& lengths() const { return discretisation_.lengths; }
  const Array<double>& weights() const { return discretisation_.weights; }
  const mesh::Sides& sides() const { return held(sides_); }
  double area() const { return area_; }
  bool closed() const { return structure_.topology.type.closed(); }

  /// Harmonic forms, differentials theta_j and period matrix of the surface without poles.
  const structure::Structure& structure() const { return structure_; }
  forms::ClosedForms harmonic() const { return {structure_.topology.classes, *structure_.harmonic.functions}; }
  int form_count() const { return static_cast<int>(structure_.differentials.cols()); }
  bool has_jacobian() const { return closed() && form_count() > 0; }

  /// theta_j on the samples: A, and B of the discretisation (uv/density_objective.h).
  const uv::SampledParts& holomorphic() const { return holomorphic_; }
  const std::vector<int>& samples() const { return samples_; }
  /// #triangles x #harmonic forms: h_x - i h_y of the harmonic forms on triangles, x along side 0.
  MatrixXcd derivatives(const std::vector<int>& triangles) const;

  /// The vertex whose Green's function is solved for instead: itself, or the vertex of the level that it was collapsed
  /// into.
  int solved_vertex(int vertex) const { return on_level_ ? level_vertex_[vertex] : vertex; }
  /// #samples x #vertices: A of the Green's functions of such vertices, in the frames of the level where there is one.
  /// @throws SolverError, Cancelled
  MatrixXcd solve_greens(const std::vector<int>& solved_vertices, Execution& execution) const;
  /// #samples, factors that take A from the frames of the level to those of the surface; empty without a level.
  const VectorXcd& from_level() const { return from_level_; }

  /// The solver on the surface's own triangles; null where nothing has to be solved for.
  const std::shared_ptr<const Solver>& solver() const { return solver_; }

  /// Whether the fluxes beside a vertex are free of large rounding errors: its edges and its neighbours' have no large
  /// weights. No pole is placed elsewhere.
  bool is_certain(int vertex) const { return uncertain_.empty() || !uncertain_[vertex]; }
  /// Whether a pole may be at a vertex, if no other pole is near. @param allowed #V; empty: anywhere
  bool is_place(int vertex, const std::vector<char>& allowed) const;

 private:
  void solve(const structure::Options& options, Execution& execution);

  structure::Structure structure_;
  mesh::Discretisation discretisation_;  // on the surface's own triangles
  std::optional<mesh::Sides> sides_;
  std::vector<double> vertex_share_;  // #V of the area
  double area_ = 0;
  std::shared_ptr<const Solver> solver_;
  std::vector<int> samples_;
  uv::SampledParts holomorphic_;

  std::shared_ptr<const PoleBasis> on_level_;  // where Green's functions are solved for
  std::vector<int> level_vertex_;              // #V there
  VectorXcd from_level_;

  std::vector<char> uncertain_;  // #V, or none
};

}  // namespace holomorph::tiling
