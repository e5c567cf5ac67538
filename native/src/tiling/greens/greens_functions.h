// Green's functions: the differentials of the third kind with a pole at a vertex, on the samples of a basis.
#pragma once

#include <cstddef>
#include <memory>
#include <unordered_map>
#include <utility>
#include <vector>

#include "tiling/greens/pole_basis.h"

namespace holomorph::tiling {

/// Those of the vertices that were solved for. Has to be solved for before a parallel region, and is const in it.
class GreensFunctions {
 public:
  explicit GreensFunctions(std::shared_ptr<const PoleBasis> basis) : basis_(std::move(basis)) {}

  /// Those of the surface whose coarse level these are on, which are given up for them: each takes memory.
  GreensFunctions on(std::shared_ptr<const PoleBasis> surface) &&;

  const PoleBasis& basis() const { return *basis_; }
  const std::shared_ptr<const PoleBasis>& shared_basis() const { return basis_; }

  /// Solves for those at these vertices that are not there yet, kGreensBlock at a time. @throws SolverError, Cancelled
  void solve_at(const std::vector<int>& vertices, Execution& execution);

  /// #samples x #vertices: A of the differentials with the residue 1 at each vertex and v single-valued. With boundary,
  /// v = 0 there. Closed, the residue -1 is spread over the area, and cancels where residues sum to 0.
  /// @param every only so many-th samples are wanted. @pre solved for
  MatrixXcd at(const std::vector<int>& vertices, int every = 1) const;
  /// #samples x #free residues: the same; closed, each against the last vertex, whose residue is minus their sum.
  MatrixXcd pole_forms(const std::vector<int>& vertices, int every = 1) const;

 private:
  std::shared_ptr<const PoleBasis> basis_;
  std::unordered_map<int, VectorXcd> known_;  // by PoleBasis::solved_vertex
};

}  // namespace holomorph::tiling
