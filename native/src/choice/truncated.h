// Log maps of meshes so coarse that the stars of any two vertices meet: cones, pyramids, tetrahedra.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "choice/any_structure.h"

namespace holomorph::choice {

/// The mesh with the corners at its poles cut off and covered by triangles: the same surface, its polygons in their
/// order, then one triangle for each corner that was cut off. Now these vertices have small stars.
struct Truncation {
  mesh::Polygons polygons;
  std::vector<int> first;  ///< #C of each corner of the old mesh its corner in the new; two stand for one that was cut
  std::vector<int> cut;    ///< corners that were cut off, in the order of the triangles
  /// The corners of their triangles: towards the corner before, the vertex, towards the one after.
  std::vector<std::array<int, 3>> covers;
};

/// @pre polygons with positions. Cost: O(#C log #C)
Truncation truncated(const mesh::Polygons& polygons, const std::vector<int>& vertices);

/// The log map of a closed surface of genus 0 with positions, its poles two far corners. It is solved for on the
/// truncated mesh; UVs are those of the remaining corners, and the corners that were cut off are put back by a
/// similarity.
class Truncated final : public AnyStructure {
 public:
  /// @throws SolverError, Cancelled
  Truncated(PartPointer part, const structure::Options& options, Execution& execution);

  /// On the truncated mesh.
  const std::shared_ptr<structure::Solved>& solved() const { return refined_->solved(); }
  const Truncation& truncation() const { return truncation_; }
  int form_count() const override { return 1; }
  bool is_real() const override { return false; }
  std::vector<int> seams(Execution& execution) override;
  std::vector<int> poles() const override { return refined_->poles(); }
  void prepare_uv(Execution& execution) override { refined_->prepare_uv(execution); }
  Eigen::VectorXcd balanced_coefficients(Execution& execution) override;
  uv::UvArray uv(const Eigen::VectorXcd& coefficients, Execution& execution) override;
  uv::Kept kept(const Eigen::VectorXcd& coefficients, Execution& execution) override;

 private:
  Truncation truncation_;
  std::unique_ptr<Forms> refined_;
};

}  // namespace holomorph::choice
