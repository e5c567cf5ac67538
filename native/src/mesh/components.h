// Cutting a surface into its connected components.
#pragma once

#include <string>
#include <vector>

#include "base/execution.h"
#include "mesh/surface.h"

namespace holomorph::mesh {

/// A connected component as a surface of its own, without isolated vertices. The indices grow with the parent's, so
/// the lower vertex of an edge remains the lower one.
struct Component {
  Surface surface;
  std::vector<int> vertex_index, face_index, corner_index;  ///< index of each element in the parent
};

Component component(const Surface& surface, int which, Execution& execution);

/// Returns all components, in their order. Cost: linear, as for a single one.
std::vector<Component> components(const Surface& surface, Execution& execution);

/// Euler characteristic of a connected surface, its isolated vertices not counted.
int euler_characteristic(const Surface& surface);

/// Number of boundary loops of a surface, without building its half-edges.
int boundary_count(const Surface& surface);

/// What a connected surface is up to homeomorphism.
struct TopologicalType {
  int genus = 0, boundary_count = 0;

  bool closed() const { return boundary_count == 0; }
  /// Number of harmonic forms in a family: 2g on a closed surface; with boundary 2g + b - 1, the genus of the double.
  int form_count() const { return 2 * genus + (closed() ? 0 : boundary_count - 1); }
  /// "genus 1 and 2 boundaries"
  std::string text() const;
};

TopologicalType topological_type(const Surface& surface);

}  // namespace holomorph::mesh
