// Seamless tilings: UV maps of even density whose jumps all are translations of the texture. Read `tile` first.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "tiling/rounding_candidate.h"
#include "uv/quality.h"

namespace holomorph::tiling {

struct TilingOptions {
  double tiles = 0;  ///< number on the surface, at its median density; 0: a number that suits it
  TextureLattice lattice;
  std::optional<std::array<double, 3>> direction;  ///< in space, along which u runs as far as it can
  std::optional<double> turn;                      ///< further rotation of the texture, in radians
  double max_turn = 0.2;                           ///< largest rotation that rounding may add to them, in radians
  double evenness = 0;                             ///< from 0, conformal, to 1 (uv/evening.h)
  bool size_counts = false;                        ///< the wanted size is more important than a little shear
};

/// A form whose periods and residues are points of the problem's lattice, with its poles at vertices.
struct RoundedForm {
  std::shared_ptr<const RoundingProblem> problem;
  Candidate candidate;
  RoundingRecord record;
};

/// The conformal map whose jumps all are points of the lattice.
struct ConformalTiling {
  RoundedForm form;                                       ///< what the map was made of
  std::shared_ptr<const structure::Structure> structure;  ///< with the poles, its forms and its cut
  std::vector<int> poles;                                 ///< vertices
  std::vector<Complex> residues;                          ///< points of the lattice
  SeamlessForm seamless;
  uv::UvArray function;     ///< #V x 2, of the form
  bool straight = false;    ///< boundary loops are lines of constant v
  double distortion = 1;    ///< mean s1 / s2 that comes from the rounding alone
  double beltrami_rms = 0;  ///< root mean square of the Beltrami coefficient of the rounding
};

/// The same map, evened.
struct Tiling {
  std::shared_ptr<const ConformalTiling> conformal;
  double evenness = 0;
  uv::UvArray uv;  ///< #C x 2
};

/// Rounds the periods and residues of the placed form to the lattice, moves the poles until the rounded form is
/// holomorphic again, and integrates it.
/// @throws TopologyError where nothing with that few tiles is seamless; SolverError; Cancelled
Tiling tile(const Placement& placement, const TilingOptions& options, Execution& execution);

/// Moves some poles of a tiling (rounding_candidate.h). Nothing is rounded again, so it is quick.
/// @param tiling made of this placement
/// @throws TopologyError for poles that do not fit; SolverError; Cancelled
Tiling move_poles(const Placement& placement, const Tiling& tiling, const std::vector<PoleMove>& moves, double evenness,
                  Execution& execution);

/// Gives the tiling another evenness. Nothing is placed or rounded again; jumps and straight boundaries stay.
/// @throws SolverError, Cancelled
Tiling evened(const Tiling& tiling, double evenness, Execution& execution);

/// Measures a tiling, and what its evening added unseen.
/// @param up the axis that points up, for a texture that is to stand upright; none: the direction does not count
/// @throws SolverError, Cancelled
uv::Quality quality(const Tiling& tiling, std::optional<uv::Up> up, Execution& execution);

}  // namespace holomorph::tiling
