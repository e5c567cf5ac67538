// A connected part of a mesh, for which a map is chosen.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string_view>
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

// Parts that are copies of each other: moved, turned about the vertical and scaled. One map does for all of them.

struct Copy {
  int first = 0;     ///< index of the part that stands for a part, which may be itself
  double scale = 1;  ///< lengths over those of that one
};

/// The copy that each part is: of the first part with the same polygons and triangles, numbered alike, whose lengths
/// and heights are the same but for one factor and the rounding of single precision. @throws Cancelled. Cost: O(#C + n
/// log n)
std::vector<Copy> copies(const std::vector<PartPointer>& parts, Execution& execution);

/// Equal for values of the same bytes.
template <class Values>
std::size_t hash_of(const Values& values) {
  const auto* bytes = reinterpret_cast<const char*>(values.data());
  return std::hash<std::string_view>()({bytes, values.size() * sizeof(values[0])});
}

}  // namespace holomorph::choice
