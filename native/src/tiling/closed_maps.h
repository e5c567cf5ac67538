// Seamless maps of a closed surface with poles at given vertices: one form is solved for, and no basis of forms.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "structure/harmonic_systems.h"
#include "structure/punctured_structure.h"
#include "tiling/landscape.h"
#include "tiling/seamless_map.h"

namespace holomorph::tiling {

class ClosedMaps {
 public:
  /// The landscape outlives this.
  /// @param vertices at least two. @throws TopologyError, SolverError, Cancelled, as punctured_structure does
  ClosedMaps(const Landscape& landscape, const std::vector<int>& vertices, const std::vector<int>& names,
             const structure::Options& options, Execution& execution);
  ClosedMaps(const ClosedMaps&) = delete;
  ClosedMaps& operator=(const ClosedMaps&) = delete;

  const std::vector<int>& vertices() const { return structure_->punctures.vertices; }
  /// Surface, topology, punctures and stars.
  const std::shared_ptr<const structure::Structure>& structure() const { return structure_; }

  /// @param X as the tiling_problem has it: periods besides the poles in the classes of the landscape
  /// @param r residues of the poles but the last
  SeamlessForm form(const Eigen::VectorXcd& X, const Eigen::VectorXcd& r, const TextureLattice& lattice) const;
  /// #V x 2. Cost: 2 solves. @throws SolverError, Cancelled
  uv::UvArray function(const SeamlessForm& form, Execution& execution);

 private:
  // What there is of a surface whose diagonals are flipped away from the poles.
  struct Flipped {
    mesh::HalfEdges half_edges;
    Array<double> weights;
  };

  forms::Poles make_structure(const Landscape& landscape, structure::Punctures punctures, Execution& execution);
  const mesh::HalfEdges& half_edges() const { return flipped_ ? flipped_->half_edges : landscape_.half_edges(); }
  const Array<double>& weights() const { return flipped_ ? flipped_->weights : landscape_.weights(); }

  const Landscape& landscape_;
  std::optional<Flipped> flipped_;
  std::shared_ptr<const structure::Structure> structure_;
  forms::Poles poles_;
  std::shared_ptr<structure::HarmonicSystems> systems_;  // the landscape's where it has the same triangles
  Eigen::MatrixXd change_;                               // from the classes of the landscape to those of the structure
  Eigen::MatrixXd pole_parts_;                           // in the classes of the landscape
};

}  // namespace holomorph::tiling
