// Where the cones of a turned map are: whole numbers of k-th turns that are missing around vertices.
#pragma once

#include <optional>
#include <vector>

#include "base/execution.h"
#include "tiling/cones/net.h"
#include "tiling/cones/scale_form.h"

namespace holomorph::tiling {

/// The angle at vertex v is 2 pi (1 - missing[v] / k). A hole has what its polygon would have, at its place_of.
struct Cones {
  std::vector<int> missing;  ///< #V
  double u2 = 0;             ///< the integral of u^2 over the surface, its area 1
  double price = 0;          ///< of the cones
};

struct ConeOptions {
  int k = 4;              ///< the map may turn by k-th parts of a full turn
  double price = 0.0001;  ///< of a cone of one k-th turn that is hidden, up to six times as much where it is seen: what
                          ///< it is to take off the mean square of the logarithm of the scale
  std::optional<Along> along;  ///< none: any direction
  /// Cones are about as far apart as centres of turns are where there are so many tiles.
  double tiles = 400;
};

/// Finds cones with which the log scale u of the flat metric, L u = (2 pi / k) missing - defect, is near 0, and with
/// which handles turn by nearly whole k-th turns. The quadratic form of u in the cones is known at all vertices by
/// Green's functions; cones jump, appear and vanish in pairs while that lowers the cost, with the price of a cone
/// rising. Begins with cones placed by curvature, and with those of the smoothest field of k directions that is pulled
/// level (Knoeppel and others 2013, doi:10.1145/2461912.2462005), by several weights of that.
/// @return those of each start. @throws SolverError, Cancelled
/// @param surface some thousand triangles: all Green's functions are kept
std::vector<Cones> find_cones(const mesh::Surface& surface, const ConeOptions& options, Execution& execution);

/// Goes on from cones that were found on a coarser level of the surface, #V.
Cones refined_cones(const mesh::Surface& surface, const std::vector<int>& missing, const ConeOptions& options,
                    Execution& execution);

/// Goes on from the cones of a field, #V, each within its patch. @param patch #V, where cones stay: below 0
Cones cones_in_patches(const mesh::Surface& surface, const Net& net, const std::vector<int>& patch,
                       const std::vector<int>& missing, const ConeOptions& options, Execution& execution);

}  // namespace holomorph::tiling
