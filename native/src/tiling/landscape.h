// A surface as the search for poles sees it: its holomorphic forms and the differentials of the third kind with a pole
// at any vertex, on samples spread over the area.
#pragma once

#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

#include "structure/harmonic_solver.h"
#include "structure/options.h"
#include "structure/structure.h"
#include "tiling/coarse_level.h"
#include "uv/log_variance.h"

namespace holomorph::tiling {

/// Everything on the surface's own triangles.
class Landscape {
 public:
  /// @pre connected, no isolated vertices. @throws SolverError, Cancelled
  Landscape(std::shared_ptr<const mesh::Surface> surface, const structure::Options& options, Execution& execution);
  /// Of a large surface: sampled where its coarse level is, whose forms with poles are taken for its own.
  Landscape(std::shared_ptr<const mesh::Surface> surface, const structure::Options& options,
            std::unique_ptr<Landscape> on_level, const CoarseLevel& level, Execution& execution);
  Landscape(const Landscape&) = delete;
  Landscape& operator=(const Landscape&) = delete;

  const mesh::Surface& surface() const { return *structure_.surface; }
  const mesh::Discretisation& discretisation() const { return discretisation_; }
  const mesh::HalfEdges& half_edges() const { return discretisation_.half_edges; }
  const Array<double>& lengths() const { return discretisation_.lengths; }
  const Array<double>& weights() const { return discretisation_.weights; }
  double area() const { return area_; }
  bool closed() const { return structure_.topology.type.closed(); }

  /// Harmonic forms, differentials theta_j and period matrix of the surface without poles.
  const structure::Structure& structure() const { return structure_; }
  forms::ClosedForms harmonic() const { return {structure_.topology.classes, *structure_.harmonic.functions}; }
  int form_count() const { return static_cast<int>(structure_.differentials.cols()); }

  /// theta_j on the samples: A, and B of the discretisation (uv/log_variance.h).
  const uv::SampledParts& holomorphic() const { return holomorphic_; }
  const std::vector<int>& samples() const { return samples_; }

  /// #samples x #vertices: A of the differentials with the residue 1 at each vertex and v single-valued; with boundary
  /// v = 0 there; closed, the residue -1 is spread over the area, so that it cancels where residues sum to 0.
  /// Solved for once for each vertex and kept. @param every only so many-th samples are wanted
  /// @throws SolverError, Cancelled
  Eigen::MatrixXcd poles(const std::vector<int>& vertices, Execution& execution, int every = 1);
  /// What was solved for poles is not wanted any more.
  void forget_poles();

  /// What solves on the surface's own triangles; null where nothing had to be solved for.
  const std::shared_ptr<structure::HarmonicSolver>& solver() const { return solver_; }

  /// Whether rounding is not seen in the fluxes beside a vertex: its neighbours have no large weights. Elsewhere no
  /// pole is placed.
  bool is_certain(int vertex) const { return uncertain_.empty() || !uncertain_[vertex]; }

  const mesh::Sides& sides() const { return *sides_; }
  /// #triangles x #harmonic forms: h_x - i h_y of the harmonic forms on triangles, x along side 0.
  Eigen::MatrixXcd derivatives(const std::vector<int>& triangles) const;

 private:
  void solve(const structure::Options& options, Execution& execution);
  void solve_for(const std::vector<int>& vertices, Execution& execution);

  structure::Structure structure_;
  mesh::Discretisation discretisation_;  // on the surface's own triangles
  std::optional<mesh::Sides> sides_;
  std::vector<double> vertex_share_;  // #V of the area
  double area_ = 0;
  std::shared_ptr<structure::HarmonicSolver> solver_;
  std::vector<int> samples_;
  uv::SampledParts holomorphic_;
  std::unordered_map<int, Eigen::VectorXcd> pole_parts_;

  std::unique_ptr<Landscape> on_level_;  // where it serves for the poles
  std::vector<int> level_vertex_;        // #V there
  Eigen::VectorXcd from_level_;          // A in the frame of each sample of the level

  std::vector<char> uncertain_;  // #V, or none
};

}  // namespace holomorph::tiling
