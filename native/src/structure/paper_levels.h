// The surface and the levels of its progressive mesh as linear systems (paper § 9, steps 1 to 3 and 5). With boundary,
// the forms live on the doubles of the levels (§ 8). Natural classes are extended symmetrically, the others
// antisymmetrically.
#pragma once

#include <memory>

#include "base/execution.h"
#include "progressive/refinement.h"
#include "solver/laplace_solver.h"
#include "topology/pulled_back_classes.h"

namespace holomorph::structure {

/// A surface as the finest level of a progressive mesh, with the bases of its base mesh M0.
struct PaperLevels {
  std::shared_ptr<const progressive::ProgressiveMesh> mesh;
  int splits = 0;                        ///< from M0 to the surface
  std::vector<int> place;                ///< #V of the surface, in the numbering of the progressive mesh
  std::vector<mesh::Triple> triangles;   ///< #T in that numbering and order
  topology::IntegerForms base_classes;   ///< on the edges of M0: the natural ones, with boundary then the relative ones
  std::vector<int> base_loop_of_vertex;  ///< #V of M0 its boundary loop, -1 in the interior
  topology::DualBases bases;             ///< on the surface's half-edges

  bool closed() const { return bases.boundary.count() == 0; }
  bool on_boundary(int v) const { return bases.boundary.loop_of_vertex[v] >= 0; }
};

/// Returns the number of rows of the surface's system: #V, or with boundary those of the double. There the inner
/// vertices of the second copy follow the vertices of the surface, as in mesh::double_cover.
Eigen::Index row_count(const PaperLevels& levels);

/// Does steps 1 to 3: the progressive mesh in the order of quadric errors, and homology and cohomology bases of M0.
/// Loops are lifted to the surface and classes pulled back (step 5b), exactly.
/// @pre connected, with harmonic forms, no isolated vertices
/// @throws InvalidMesh for an intrinsic surface, and where no triangulation of the polygons is without double edges
PaperLevels paper_levels(const mesh::Surface& surface, Execution& execution);

/// Does the same for a level of a given progressive mesh, which outlives the result.
PaperLevels paper_levels(const progressive::ProgressiveMesh& mesh, int splits, const mesh::Surface& level);

/// The system L f = B on a level, or on its double. Rows are in the order of those of the surface, which keeps
/// neighbours near in memory.
struct LevelSystem {
  solver::Laplacian L;
  Eigen::MatrixXd B;     ///< -d* eta, as forms::codifferentials
  std::vector<int> row;  ///< #rows of the surface: row of the vertex that each one's vertex was collapsed into
};

/// Assembles the system of the level with this many splits, with weights from the positions. Triangles thinner than
/// about 1 : 100 count as that thin: they would cost iterations, and a level gives only an initial guess.
/// Cost: linear in the number of vertices of the surface.
LevelSystem level_system(const PaperLevels& levels, int splits);

}  // namespace holomorph::structure
