// The map of a part in pieces, from the maps of these.
#pragma once

#include <optional>
#include <vector>

#include "choice/map.h"
#include "choice/pieces.h"

namespace holomorph::choice {

/// A piece with its map, whose elements are those of the piece.
struct MappedPiece {
  const Piece* piece = nullptr;
  MapPointer map;
};

/// The map of a part from those of its pieces, of which one at least is a tiling.
/// @param cut how far the seams are seen, over the square root of the area; none along hard edges
MapPointer mixed_map(const PartPointer& part, const StructurePointer& structure, const std::vector<MappedPiece>& pieces,
                     double evenness, const std::optional<double>& cut, Execution& execution);

}  // namespace holomorph::choice
