// From periods and residues on the lattice to the UV map that has them.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "structure/pole_structure.h"
#include "tiling/greens/pole_basis.h"
#include "tiling/rounding/rounding.h"

namespace holomorph::tiling {

/// The form whose periods are points of the lattice.
struct SeamlessForm {
  VectorXcd periods;       ///< over the homology basis of its structure
  VectorXcd coefficients;  ///< for the harmonic forms
};

/// The maps with poles at given vertices. On a closed surface the function of each map is solved for, without a basis
/// of forms. With boundary it is a combination of the functions of a structure. Immutable: several threads may use one.
class SeamlessMaps {
 public:
  /// @param straight u of the loops of a boundary is rounded alone
  /// @param vertices of the poles; on a closed surface none, or at least two
  /// @param labels what a vertex is called in messages; empty: its index
  /// @throws TopologyError, SolverError, Cancelled, as pole_structure does
  SeamlessMaps(std::shared_ptr<const PoleBasis> basis, bool straight, const std::vector<int>& vertices,
               const std::vector<int>& labels, const structure::Options& options, Execution& execution);
  SeamlessMaps(const SeamlessMaps&) = delete;
  SeamlessMaps& operator=(const SeamlessMaps&) = delete;

  /// With poles on a closed surface, it has only surface, topology and poles.
  const std::shared_ptr<const structure::Structure>& structure() const { return structure_; }
  /// #natural x #free residues: harmonic parts of the poles in the classes of the basis; closed, each against the last.
  const MatrixXd& pole_parts() const { return pole_parts_; }

  /// Returns the form whose periods are the points of the lattice nearest to those that X and the residues give. @param
  /// X periods besides the poles, in the classes of the basis; with boundary c
  SeamlessForm form(const VectorXcd& X, const VectorXcd& residues, const TextureLattice& lattice) const;
  /// #V x 2. @throws SolverError, Cancelled
  uv::UvArray function(const SeamlessForm& form, Execution& execution) const;

 private:
  void set_up_closed(structure::Poles poles, const structure::Options& options, Execution& execution);
  void cut_at(structure::Poles poles, Execution& execution);
  const mesh::Discretisation& discretisation() const { return flipped_ ? *flipped_ : basis_->discretisation(); }

  std::shared_ptr<const PoleBasis> basis_;
  bool straight_;
  std::shared_ptr<const structure::Structure> structure_;
  MatrixXd change_;  // from the classes of the basis to those of the structure
  MatrixXd pole_parts_;

  // On a closed surface with poles:
  std::optional<mesh::Discretisation> flipped_;  // a surface whose diagonals are flipped away from the poles
  forms::PoleForms pole_forms_;
  std::shared_ptr<const PoleBasis::Solver> solver_;  // that of the basis where it has the same triangles
};

/// Returns the periods of the natural classes of `old` over the loops of `s`, a structure of the same polygons:
/// integers, #loops x #loops.
MatrixXd change_of_basis(const topology::IntegerForms& old, const structure::Structure& s);

/// Returns the function of the form, #V x 2, a combination of those of the forms of `s`.
uv::UvArray function_of(const structure::Structure& s, const SeamlessForm& form, Execution& execution);

/// Returns the UVs, #C x 2, of the form with this function, moved by whole tiles to the middle of the plane. They are
/// rounded to a grid of powers of two that single precision holds. So the two sides of a cut differ by their jump
/// there, too, exactly.
uv::UvArray seamless_uv(const structure::Structure& s, const SeamlessForm& form, uv::UvArray function,
                        Execution& execution);

}  // namespace holomorph::tiling
