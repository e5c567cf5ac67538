// Some faces of a polygon mesh as a mesh of their own.
#pragma once

#include <vector>

#include "mesh/polygons.h"

namespace holomorph::mesh {

/// The vertices keep their order, so the lower end of an edge remains the lower one.
struct PolygonPart {
  Polygons polygons;                                        ///< without positions where the whole has none
  std::vector<int> vertex_index, face_index, corner_index;  ///< each element's index in the whole
};

/// Takes parts out, one after the other, each in time linear in its own size.
class PolygonParts {
 public:
  /// The mesh outlives this.
  explicit PolygonParts(const Polygons& whole);

  /// @param faces ascending; their vertices exist
  PolygonPart take(std::vector<int> faces);

 private:
  const Polygons& whole_;
  std::vector<int> new_vertex_;  // in the part that is taken, else -1
};

}  // namespace holomorph::mesh
