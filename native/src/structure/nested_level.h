// One level of a refinement: the harmonic forms of given integer classes on a triangulation of a surface, by elements
// of some order. Keeps the Delaunay triangulation that they were solved on, to be refined further.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/execution.h"
#include "forms/closed_forms.h"
#include "mesh/surface.h"
#include "structure/structure.h"

namespace holomorph::structure {

/// #T x 3 m: the values of m closed integer forms along the sides of triangles, from corner i to corner i + 1.
using SideClasses = Eigen::Matrix<int, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Returns the classes that the harmonic forms of a structure were solved for, on its surface: the natural ones, and
/// with boundary the Dirichlet ones.
SideClasses side_classes(const Structure& structure);

struct NestedLevel {
  std::vector<mesh::Triple> triangles;       ///< #T corners in the Delaunay triangulation
  std::vector<mesh::Triple> triangle_edges;  ///< #T edges; side i begins at corner i
  std::vector<double> lengths;               ///< #E
  std::vector<double> errors;                ///< #T mesh::FaceError::largest; 1 where the metric is another one
  SideClasses classes;                       ///< on that triangulation
  forms::RowMajorMatrix functions;           ///< see forms::ElementForms::solve
  CertainGram energies;
  std::vector<double> gaps;  ///< #T, see forms::ElementForms::gaps
  double mollification = 0;  ///< other than 0: bounds would belong to another surface, and nothing is solved
};

/// Solves for the forms of these classes by elements of order p.
/// @param natural how many of the classes are natural; the others are Dirichlet
/// @throws SolverError, Cancelled
NestedLevel solve_level(const mesh::Surface& surface, const SideClasses& classes, int natural, int order,
                        Execution& execution);

/// #T, by what part rounding its lengths may change energies on each triangle of a surface.
std::vector<double> length_errors(const mesh::Surface& surface);

/// Measures the forms eta_i + d f_i with any functions on the Delaunay triangulation of the surface: admissible ones,
/// whatever they are, so that bounds hold.
/// @param functions #V x m; those of Dirichlet forms count as 0 on the boundary
CertainGram measure(const mesh::Surface& surface, const SideClasses& classes, int natural,
                    const forms::RowMajorMatrix& functions, Execution& execution);

/// The same by elements of order p. @param functions see forms::ElementForms::solve
CertainGram measure_level(const mesh::Surface& surface, const SideClasses& classes, int natural, int order,
                          const forms::RowMajorMatrix& functions, Execution& execution);

/// Replaces the Gram matrices of a structure by those of the same forms on a finer level, and all that follows from
/// them.
/// @throws SolverError
Structure narrowed(Structure structure, CertainGram energies, double metric);

}  // namespace holomorph::structure
