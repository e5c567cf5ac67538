// Evening: a map gets squares of nearly one size, and keeps its jumps and straight boundaries.
#pragma once

#include <vector>

#include "base/execution.h"
#include "mesh/surface.h"
#include "uv/strain_energy.h"
#include "uv/turned_functions.h"
#include "uv/uv_map.h"

namespace holomorph::uv {

/// The evenness that suits textures: squares hardly differ in size, and their shear is not seen.
inline constexpr double kUsualEvenness = 0.5;

/// Predicts the 95:5 ratio of densities, with caution: this evenness raises that of a conformal map to at most this
/// power on most surfaces. The median of 25 meshes is 0.57; tori have 0.64.
inline constexpr double kUsualPower = 0.6;

/// How far evening goes.
struct EveningOptions {
  /// "auto", "direct" or "multigrid" of a map that only shifts; kDiagonal of one that turns and is nearly even.
  std::string solver = "auto";
  int steps = 40;  ///< from a conformal map: after fewer the energy hardly falls
  /// What turning flipped triangles back may take, in steps on the whole surface; 0: they stay.
  double turning = 100;
};
inline constexpr const char* kDiagonal = "diagonal";

/// Returns the function, #V x 2, that gives the map the least StrainEnergy when it is added at the vertices. Triangles
/// that it flips are turned back until no more area is flipped than before. Where moving their neighbours is not
/// enough, the function fades around them; then the weight of size is lowered again and again. At last nothing is
/// added.
///
/// Method: gradient descent, preconditioned by the Laplacian closest to the second derivatives, which is made anew
/// while the energy falls quickly. Then limited-memory BFGS with the last Laplacian.
/// @param uv #C x 2, with translations for jumps. @param evenness from 0, which gives 0, to 1
/// @pre the surface is connected and has no isolated vertices. @throws SolverError, Cancelled
uv::UvArray evened(const mesh::Surface& surface, uv::UvArray uv, const Kept& kept, double evenness,
                   Execution& execution, const EveningOptions& options = {});

/// Returns the StrainEnergy of the map itself, with the weight of size that this evenness gives. @param uv, kept as
/// above
double strain(const mesh::Surface& surface, const uv::UvArray& uv, const Kept& kept, double evenness,
              Execution& execution);

}  // namespace holomorph::uv
