// Green's functions: the differentials of the third kind with a pole at a vertex, on the samples of a basis.
#pragma once

#include <cstddef>
#include <memory>
#include <unordered_map>
#include <utility>
#include <vector>

#include "tiling/greens/pole_basis.h"

namespace holomorph::tiling {

/// The Green's functions of the vertices that were solved for. Call `solve_at` before a parallel region: all other
/// members are const.
class GreensFunctions {
 public:
  explicit GreensFunctions(std::shared_ptr<const PoleBasis> basis) : basis_(std::move(basis)) {}

  /// Takes these functions, on a coarse level, for those of its surface. This object is left without any, to save
  /// memory.
  GreensFunctions on(std::shared_ptr<const PoleBasis> surface) &&;

  const PoleBasis& basis() const { return *basis_; }
  const std::shared_ptr<const PoleBasis>& shared_basis() const { return basis_; }

  /// Solves for the functions of these vertices that are missing, kGreensBlock at a time. @throws SolverError,
  /// Cancelled
  void solve_at(const std::vector<int>& vertices, Execution& execution);

  /// Returns A, #samples x #vertices, of the differentials with the residue 1 at each vertex and v single-valued. With
  /// boundary, v = 0 there. Closed, the residue -1 is spread over the area, and cancels where residues sum to 0.
  /// @param every stride of the samples that are returned. @pre `solve_at` was called for these vertices
  MatrixXcd at(const std::vector<int>& vertices, int every = 1) const;
  /// Returns the same for the free residues, #samples x #free residues: on a closed surface each function minus that of
  /// the last vertex, whose residue is minus the sum of the others.
  MatrixXcd pole_forms(const std::vector<int>& vertices, int every = 1) const;

 private:
  std::shared_ptr<const PoleBasis> basis_;
  std::unordered_map<int, VectorXcd> known_;  // by PoleBasis::solved_vertex
};

}  // namespace holomorph::tiling
