// The maps of all parts of several objects, with squares of one size. Read `automatic_map` first.
#pragma once

#include <exception>
#include <optional>
#include <vector>

#include "choice/map.h"
#include "choice/part.h"
#include "choice/request.h"
#include "choice/size.h"

namespace holomorph::choice {

/// The size of squares that is asked for. One part leads: its median density is then that of all others.
struct SizePolicy {
  double density = 0;  ///< tiles per unit of area
  int tries = kTries;  ///< numbers of tiles that are tried on the leading part
  /// Relative amount by which its median density may differ from the wanted one; none for any, and 0 where no part
  /// leads, as other meshes have that density.
  std::optional<double> tolerance;
  std::optional<Window> window;  ///< of the other parts, over the density of the leading one; none: that of most
  double near = 0.2;             ///< relative amount by which tilings may miss it where other maps cost more by as much

  /// By tiles over all parts, in proportion to their areas. @param tiles 0: 100, or 64 for each handle, over the
  /// largest
  static SizePolicy of_tiles(const std::vector<PartPointer>& parts, double tiles);
  /// By tiles per unit of area. @param tolerance as above
  static SizePolicy of_density(double density, double tolerance);
};

/// The map of a part, or what refuses it.
struct Made {
  MapPointer map;              ///< of the part that this is a copy of; null where that is refused
  std::exception_ptr refused;  ///< Error or std::bad_alloc
  Copy copy;
};

struct MappedParts {
  std::vector<Made> parts;
  SizePolicy size;  ///< with which that object alone gets the same maps
};

/// The maps of the parts of each object, with squares of one size over all of them.
///
/// The median densities of tilings differ by a tenth at most from that of the largest part, which is made first, or by
/// up to a fifth where other maps cost more. A part on which whole tiles are too few for that, or have no room, gets
/// another map, to be scaled where they are laid out. Small parts are made side by side, and copies of one part once.
/// @throws Cancelled
std::vector<MappedParts> map_objects(const std::vector<std::vector<Request>>& objects, const SizePolicy& size,
                                     Execution& execution);

/// The map of one connected part of any kind.
///
/// It is the one of lowest visual cost (uv/appearance.h) among flat islands, tilings, the balanced map and maps in
/// pieces, some of them tilings. A part that is flat, or falls into flat pieces at its hard edges, gets these at once.
/// What cannot cost less than what was found is not tried. Source: ours, docs/choice.md
/// @throws what `automatic_structure` throws; TopologyError or SolverError if a tiling was asked for and cannot be
/// made, or would lose more than 2 % of the area, as on a mesh of few faces; Cancelled
MapPointer automatic_map(const Request& request, const SizePolicy& size, Execution& execution);

}  // namespace holomorph::choice
