// Seamless maps of a closed surface with poles at given vertices: one form is solved for, and no basis of forms.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "structure/harmonic_solver.h"
#include "structure/pole_structure.h"
#include "tiling/landscape.h"
#include "tiling/seamless_map.h"

namespace holomorph::tiling {

class ClosedMaps {
 public:
  /// The landscape outlives this.
  /// @param vertices at least two. @throws TopologyError, SolverError, Cancelled, as pole_structure does
  ClosedMaps(const Landscape& landscape, const std::vector<int>& vertices, const std::vector<int>& names,
             const structure::Options& options, Execution& execution);
  ClosedMaps(const ClosedMaps&) = delete;
  ClosedMaps& operator=(const ClosedMaps&) = delete;

  const std::vector<int>& vertices() const { return structure_->poles->chosen.vertices; }
  /// Surface, topology and poles.
  const std::shared_ptr<const structure::Structure>& structure() const { return structure_; }

  /// @param X as the tiling_problem has it: periods besides the poles in the classes of the landscape
  /// @param r residues of the poles but the last
  SeamlessForm form(const Eigen::VectorXcd& X, const Eigen::VectorXcd& r, const TextureLattice& lattice) const;
  /// #V x 2. Cost: 2 solves. @throws SolverError, Cancelled
  uv::UvArray function(const SeamlessForm& form, Execution& execution);

 private:
  forms::PoleForms make_structure(const Landscape& landscape, structure::Poles poles, Execution& execution);
  const mesh::Discretisation& discretisation() const { return flipped_ ? *flipped_ : landscape_.discretisation(); }

  const Landscape& landscape_;
  std::optional<mesh::Discretisation> flipped_;  // of a surface whose diagonals are flipped away from the poles
  std::shared_ptr<const structure::Structure> structure_;
  forms::PoleForms poles_;
  std::shared_ptr<structure::HarmonicSolver> solver_;  // the landscape's where it has the same triangles
  Eigen::MatrixXd change_;                             // from the classes of the landscape to those of the structure
  Eigen::MatrixXd pole_parts_;                         // in the classes of the landscape
};

}  // namespace holomorph::tiling
