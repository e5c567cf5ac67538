// The basis of forms with poles: the holomorphic forms of a surface, and what solves for Green's functions, on samples
// spread over the area.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <cstddef>
#include <memory>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/constants.h"
#include "base/errors.h"
#include "base/execution.h"
#include "base/resource_pool.h"
#include "mesh/surface.h"
#include "structure/harmonic_solver.h"
#include "structure/solver_report.h"
#include "structure/structure.h"
#include "tiling/levels.h"
#include "uv/density_objective.h"

namespace holomorph::tiling {

// The short names of matrices in this room.

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

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

// Green's functions: the differentials of the third kind with a pole at a vertex, on the samples of a basis.

/// The Green's functions of the vertices that were solved for. Call `solve_at` before a parallel region: all other
/// members are const.
class GreensFunctions {
 public:
  explicit GreensFunctions(std::shared_ptr<const PoleBasis> basis) : basis_(std::move(basis)) {}

  /// Takes these functions, on a coarse level, for those of its surface. This object is left without any, to save
  /// memory.
  GreensFunctions on(std::shared_ptr<const PoleBasis> surface) &&;

  const PoleBasis& basis() const { return *basis_; }
  const std::shared_ptr<const PoleBasis>& shared_basis() const { return basis_; }

  /// Solves for the functions of these vertices that are missing, kGreensBlock at a time. @throws SolverError,
  /// Cancelled
  void solve_at(const std::vector<int>& vertices, Execution& execution);

  /// Returns A, #samples x #vertices, of the differentials with the residue 1 at each vertex and v single-valued. With
  /// boundary, v = 0 there. Closed, the residue -1 is spread over the area, and cancels where residues sum to 0.
  /// @param every stride of the samples that are returned. @pre `solve_at` was called for these vertices
  MatrixXcd at(const std::vector<int>& vertices, int every = 1) const;
  /// Returns the same for the free residues, #samples x #free residues: on a closed surface each function minus that of
  /// the last vertex, whose residue is minus the sum of the others.
  MatrixXcd pole_forms(const std::vector<int>& vertices, int every = 1) const;

 private:
  std::shared_ptr<const PoleBasis> basis_;
  std::unordered_map<int, VectorXcd> known_;  // by PoleBasis::solved_vertex
};

}  // namespace holomorph::tiling
