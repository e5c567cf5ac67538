// Shortest paths along the edges of polygons to a border: where to cut a surface open.
#pragma once

#include <vector>

#include "base/execution.h"
#include "mesh/surface.h"

namespace holomorph::mesh {

/// Whether a vertex lies on the boundary or at one of the cuts, #V. @param is_cut #E; empty: none
std::vector<char> on_border(const Surface& surface, const std::vector<char>& is_cut);

/// A forest whose roots are the vertices of the border.
struct BorderPaths {
  std::vector<double> distances;    ///< #V; infinite where no path leads to the border
  std::vector<int> edge_to_border;  ///< #V the first edge of the path, the lowest of equals; -1 at its end

  /// Marks the path from a vertex, as far as it is not marked yet. @param is_marked #E
  void mark(const Surface& surface, int vertex, std::vector<char>& is_marked) const;
};

/// @param is_border #V. @param times #E, by which lengths are multiplied; empty: 1. Cost: O(n log n)
BorderPaths border_paths(const Surface& surface, const std::vector<char>& is_border, const std::vector<double>& times,
                         Execution& execution);

/// Returns the paths from these vertices to the border, #E. @param starts #V
std::vector<char> paths_to_border(const Surface& surface, const std::vector<char>& is_border,
                                  const std::vector<char>& starts, Execution& execution);

}  // namespace holomorph::mesh
