// The preconditioner of functions that turn from corner to corner: u and v are unknowns of one system.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/execution.h"
#include "base/page_allocator.h"
#include "evening/unknowns.h"
#include "mesh/surface.h"
#include "solver/direct/sparse_cholesky.h"
#include "solver/laplace_solver.h"

namespace holomorph::evening {

/// The parts of a function that turns by quarters, with both signs, as vertices of a graph: the parts of one end of an
/// edge are, up to their signs, those of the other end. So the Laplacian of the connection is the plain Laplacian of
/// this graph, on functions that change sign with the part; multigrid knows only plain ones.
struct Cover {
  /// @return none where functions turn by other angles, or no part is held in a piece of the graph
  static std::unique_ptr<Cover> of(const mesh::Surface& surface, const Kept& kept);

  int ground() const { return static_cast<int>(starts.size()) - 2; }  ///< the vertex of all parts that are 0
  solver::Laplacian laplacian(const Array<double>& edge_weights) const;

  struct Edge {
    int edge;                               ///< of the surface
    int ends[2], entries[2], diagonals[2];  ///< and where its entries are
  };
  std::vector<Edge> edges;
  Array<int> starts, columns;  ///< of the Laplacian. Unknown i is vertex 2 i, and less that is vertex 2 i + 1
};

class TurnedSolver {
 public:
  /// @param solver "auto", "direct" or "multigrid"
  TurnedSolver(const mesh::Surface& surface, const Kept& kept, const std::string& solver);

  void make(const Array<double>& edge_weights, Execution& execution);
  Function precondition(const Function& gradient, Execution& execution);

 private:
  const mesh::Surface& surface_;
  const Kept& kept_;
  std::unique_ptr<Cover> cover_;  // none: the factor
  std::unique_ptr<solver::LaplaceSolver> multigrid_;
  solver::SparseCholesky factor_;
};

}  // namespace holomorph::evening
