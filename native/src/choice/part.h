// A connected part of a mesh, for which a map is chosen.
#pragma once

#include <memory>
#include <vector>

#include "base/execution.h"
#include "mesh/components.h"
#include "mesh/surface.h"
#include "uv/direction.h"

namespace holomorph::choice {

/// What refuses one part; others go on. @see InvalidMesh, TopologyError, SolverError
template <class Make, class Refused>
auto unless_refused(const Make& make, const Refused& refused) -> decltype(make()) {
  try {
    return make();
  } catch (const InvalidMesh& error) {
    return refused(error);
  } catch (const TopologyError& error) {
    return refused(error);
  } catch (const SolverError& error) {
    return refused(error);
  }
}

/// A connected surface without isolated vertices.
struct Part {
  std::shared_ptr<const mesh::Surface> surface;
  uv::Up up = uv::Up::kZ;   ///< the axis of the positions that points up
  std::vector<int> labels;  ///< #V what a vertex is called in messages; empty: its index
  mesh::TopologicalType type;
  double area = 0;

  bool has_positions() const { return !surface->intrinsic(); }
  int triangle_count() const { return static_cast<int>(surface->triangles.size()); }
  /// Whether it is a sphere with two holes.
  bool is_tube() const { return type.genus == 0 && type.boundary_count == 2; }
};
using PartPointer = std::shared_ptr<const Part>;

PartPointer part_of(std::shared_ptr<const mesh::Surface> surface, uv::Up up, std::vector<int> labels,
                    Execution& execution);

/// Runs a computation in the current stage or part of a longer one.
template <class Compute>
auto nested(Execution& execution, double from, double to, const Compute& compute) {
  execution.part(from, to);
  const Execution::Within within(execution);
  return compute();
}

}  // namespace holomorph::choice
