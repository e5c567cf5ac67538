// Functions with prescribed values, harmonic or with a prescribed Laplacian.
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/execution.h"
#include "forms/refined_solver.h"
#include "mesh/delaunay.h"
#include "mesh/surface.h"
#include "structure/solver_report.h"
#include "structure/structure.h"

namespace holomorph::flat {

using structure::Options;

/// One fixed map of a disk to the plane, continuous everywhere.
struct PlaneMap {
  Eigen::VectorXcd points;                   ///< #V
  std::vector<int> corners;                  ///< four vertices of a rectangle
  double modulus = 0, lower = 0, upper = 0;  ///< height over width of a rectangle, and its bounds
  Eigen::VectorXd scale_factors;  ///< #V of a map with free boundary: length in the plane over that on the surface
  std::vector<int> collapsed_triangles;  ///< triangles all of whose corners lie on one side of a rectangle
  double harmonicity = 0;                ///< largest |L f| at a free vertex over the largest sum of its terms
  double mollification = 0;
  double metric = 0;  ///< as in structure::Certificate
  int flip_count = 0;
  structure::SolverReport solver;
  std::vector<std::pair<std::string, double>> seconds;
};

struct DirichletSolution {
  Eigen::MatrixXd functions;  ///< #V x m
  Eigen::VectorXd energies;   ///< m, f . L f
  double harmonicity = 0;     ///< largest |L f| at a free vertex over the largest sum of its terms
  structure::SolverReport solver;
};

/// Computes sum_e k_e (f_head - f_tail)^2 of each column, m numbers, for any weights k_e.
Eigen::VectorXd energies(const mesh::HalfEdges& half_edges, std::span<const double> weights,
                         const Eigen::MatrixXd& functions);

/// The linear system for one set of fixed vertices, natural at the rest of the boundary, with several right-hand sides.
/// Refined where weights are large (forms/refined_solver.h).
class DirichletProblem {
 public:
  /// @param columns about how many right-hand sides there will be, for the choice of the solver
  /// @pre the discretisation outlives this. @throws SolverError, Cancelled
  DirichletProblem(const mesh::Discretisation& discretisation, const std::vector<int>& fixed, int columns,
                   const structure::Options& options, Execution& execution);

  /// Solves L f = 0 at the free vertices, f = `values` at the fixed ones.
  /// @param values #V x m, 0 at the free vertices
  /// @throws SolverError, Cancelled
  DirichletSolution harmonic(const Eigen::MatrixXd& values, Execution& execution);

  /// Solves L f = `sources` at the free vertices, f = 0 at the fixed ones: #V x m.
  /// @param sources #V x m; the rows of fixed vertices are ignored
  /// @throws SolverError, Cancelled
  Eigen::MatrixXd poisson(const Eigen::MatrixXd& sources, Execution& execution);

 private:
  const mesh::Discretisation& discretisation_;
  std::vector<int> fixed_;
  solver::Laplacian laplacian_;
  forms::RefinedSolver solver_;
};

/// Solves as `DirichletProblem::harmonic` does, for a problem with no other right-hand sides.
DirichletSolution solve_dirichlet(const mesh::Discretisation& discretisation, const std::vector<int>& fixed,
                                  const Eigen::MatrixXd& values, const structure::Options& options,
                                  Execution& execution);

// Maps to the disk and to the sphere.

/// Computes z = exp(2 pi i (u + iv)), #V, of a disk with one pole of residue 1: 0 at the pole, |z| = 1 on the boundary,
/// nowhere larger.
/// @param function #V x 2, that of theta_0 (structure::PrimalForms). @pre such a structure
Eigen::VectorXcd disk_map(const structure::Structure& structure, const uv::UvArray& function, Workers& workers);

using PointArray = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// @throws TopologyError unless the surface is closed, of genus 0, with two poles
void require_sphere(const structure::Structure& structure);

/// Computes #V x 3 points of the unit sphere; keeps the orientation. z = exp(2 pi i (u + iv)) is 0 at the first pole,
/// of residue 1, and infinite at the second. z is scaled so that the mean height over the surface's area is 0. Then
/// inverse stereographic projection takes the poles to (0, 0, 1) and (0, 0, -1).
/// @param function #V x 2, that of theta_0 (structure::PrimalForms). @pre require_sphere
PointArray sphere_map(const structure::Structure& structure, const uv::UvArray& function, Workers& workers);

// The conformal map of a disk to the plane with a free boundary and the least variation of density.

/// Computes the conformal map to the plane that keeps lengths along the boundary. Its scale factors are e^u, with u = 0
/// on the boundary. Among all conformal maps this u has the least Dirichlet energy. A surface that is flat already is
/// mapped by a rigid motion.
///
/// In the interior L u = -K, with K the angle defect from 2 pi. The flattened boundary turns by k + L u at each vertex,
/// with k the defect from pi. The curve with these angles is closed by the lengths nearest to those of the surface.
/// Both coordinates are extended harmonically. Where curvature is large and the mesh coarse the image may overlap
/// itself.
///
/// The lowest boundary vertex lies at 0, and the edge that leaves it, the surface on its left, along the real axis.
/// @throws TopologyError for a surface that is not a disk; SolverError; Cancelled
/// Cost: one factorisation, three right-hand sides.
/// Source: Sawhney & Crane 2017, section 4, doi:10.1145/3132705.
PlaneMap free_boundary_map(const mesh::Surface& surface, const Options& options, Execution& execution);

}  // namespace holomorph::flat
