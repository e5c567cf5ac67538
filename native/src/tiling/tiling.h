// Seamless tilings: UV maps of even density whose jumps all are translations of the texture. Read `tile` first.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "tiling/candidate.h"

namespace holomorph::tiling {

struct TilingOptions {
  double tiles = 0;  ///< over the surface at its median density; 0: a number that suits it
  TextureLattice lattice;
  std::optional<std::array<double, 3>> direction;  ///< in space, along which u runs as far as it can
  std::optional<double> turn;                      ///< by which the texture is rotated beside that, in radians
  double max_turn = 0.2;                           ///< largest change of these by the rounding, in radians
};

/// A form whose periods and residues are points of the problem's lattice, with its poles at vertices.
struct RoundedForm {
  std::shared_ptr<const RoundingProblem> problem;
  Candidate candidate;
};

/// A map whose jumps all are points of the lattice.
struct Tiling {
  std::shared_ptr<const RoundedForm> form;                ///< what the map was made of
  std::shared_ptr<const structure::Structure> structure;  ///< with the poles, its forms and its cut
  std::vector<int> poles;                                 ///< vertices
  std::vector<Complex> residues;                          ///< points of the lattice
  VectorXcd periods;                                      ///< over the homology basis of the structure
  uv::UvArray uv;                                         ///< #C x 2
  double distortion = 1;                                  ///< by the rounding alone: mean s1 / s2
  double beltrami_rms = 0;  ///< root mean square of the Beltrami coefficient of the rounding
};

/// Rounds the periods and residues of the placed form to the lattice, moves the poles until the rounded form is
/// holomorphic again, and integrates it.
/// @throws TopologyError where nothing with that few tiles is seamless; SolverError; Cancelled
Tiling tile(const Placement& placement, const TilingOptions& options, Execution& execution);

/// The tiling with some of its poles elsewhere (candidate.h). Nothing is rounded again: quick.
/// @param form of the tiling, which was made of this placement
/// @throws TopologyError for poles that do not fit; SolverError; Cancelled
Tiling move_poles(const Placement& placement, RoundedForm form, const std::vector<PoleMove>& moves,
                  Execution& execution);

}  // namespace holomorph::tiling
