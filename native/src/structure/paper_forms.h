// The paper's multiresolution algorithm (§ 9), step by step:
//
//   1  the progressive mesh of M, its base mesh M0              paper_levels
//   2  a homology basis of M0                                   paper_levels
//   3  a cohomology basis of M0                                 paper_levels
//   4  harmonic forms on M0                                     paper_forms, its first level
//   5  vertex splits: (a) the split                             level_system
//                     (b) w(v_t v_l) = w(v_s v_l), w(v_t v_r) = w(v_s v_r), w(v_s v_t) = 0
//                     (c) at thresholds, w + df made harmonic by conjugate gradients
//   6  conjugate gradients on M
//
// Forms are kept as w = eta + df. Rule 5(b) is the pull-back by the map that takes each vertex to the one it was
// collapsed into. So eta remains an integer class, and f(v_t) = f(v_s).
#pragma once

#include <optional>

#include "base/execution.h"
#include "forms/closed_forms.h"
#include "mesh/surface.h"
#include "solver/conjugate_gradients.h"
#include "solver/laplace_solver.h"
#include "structure/paper_levels.h"
#include "structure/solver_report.h"
#include "structure/structure.h"

namespace holomorph::structure {

struct PaperOptions {
  /// Numbers of faces of the thresholds, in any order; M0 is always a level. An empty list means no levels at all:
  /// conjugate gradients begin at zero. By default every `ratio` in faces from `least_faces` on.
  std::optional<std::vector<std::int64_t>> thresholds;
  double ratio = 4;                     ///< faces of a threshold over those of the one before
  std::int64_t least_faces = 500;       ///< fewest faces of a threshold above M0
  double level_residual = 1e-4;         ///< relative, goal on M0 and at the thresholds
  double residual = solver::kResidual;  ///< relative, goal on M
  solver::Scaling scaling = solver::Scaling::diagonal;
};

/// Returns the numbers of splits of M0 and of the thresholds, ascending, without that of M.
std::vector<int> thresholds(const PaperLevels& levels, const PaperOptions& options);

struct PaperEstimation {
  Eigen::MatrixXd functions;  ///< #rows x #forms, see row_count
  std::vector<structure::LevelReport> levels;
};

/// Does steps 4 and 5: returns the initial guess on M, and a report of all levels but M. A threshold's residual need
/// not be small: simplification changes the solution by some thousandths from one level to the next.
/// @param coarse the levels, numbers of splits as from `thresholds`
PaperEstimation paper_estimation(const PaperLevels& levels, const std::vector<int>& coarse, const PaperOptions& options,
                                 Execution& execution);

/// Steps 4 to 6 as a solver: the first right-hand sides are those of all harmonic forms, in the order of
/// `PaperLevels::base_classes`, and begin with the estimation. Where conjugate gradients do not converge from it, as
/// among very thin triangles, they begin from one level less, and so on; where not even from zero, the direct solver
/// takes over. The remark says so. Right-hand sides of corrections begin at zero.
/// @pre `levels` outlives this
class PaperSolver final : public solver::LaplaceSolver {
 public:
  /// @param L of the surface, or of its double, in its own numbering
  PaperSolver(const PaperLevels& levels, solver::Laplacian&& L, const PaperOptions& options);

  solver::Solution solve(const Eigen::MatrixXd& B, const std::vector<solver::Condition>& conditions,
                         Execution& execution) override;
  std::string name() const override;
  std::string remark() const override { return remark_; }
  /// Those from which the forms were solved for, and the surface; none where the direct solver took over.
  const std::vector<structure::LevelReport>& levels() const { return reports_; }

 private:
  bool improve(const std::vector<int>& coarse, const Eigen::MatrixXd& B, Eigen::MatrixXd& X, Execution& execution);
  solver::Solution improved(const Eigen::MatrixXd& B, const std::vector<solver::Condition>& conditions,
                            Execution& execution);
  solver::Solution correction(const Eigen::MatrixXd& B, const std::vector<solver::Condition>& conditions,
                              Execution& execution);
  solver::Solution solved_directly(const Eigen::MatrixXd& B, const std::vector<solver::Condition>& conditions,
                                   Execution& execution);

  const PaperLevels& levels_;
  solver::Laplacian L_;
  PaperOptions options_;
  std::vector<structure::LevelReport> reports_;
  bool is_begun_ = false;
  std::unique_ptr<solver::LaplaceSolver> direct_;
  std::string remark_;
};

/// Computes a conformal structure. Loops are lifted from the base mesh, classes are pulled back, and harmonic forms
/// come from paper_forms. No edge is flipped: all results belong to the surface's own triangulation.
/// @param levels of a given progressive mesh; by default it is made here
/// @pre connected, no isolated vertices
/// @throws TopologyError for a sphere or a disk; InvalidMesh for an intrinsic surface; SolverError; Cancelled
structure::Structure paper_structure(std::shared_ptr<const mesh::Surface> surface, const structure::Options& options,
                                     Execution& execution, PaperOptions how = {},
                                     std::optional<PaperLevels> levels = {});

// The harmonic map in the class of a given one, at a level of a progressive mesh.

struct HarmonicMap {
  forms::RowMajorMatrix moves;  ///< #V x 2m, to be added to the UVs of all corners of a vertex
  structure::SolverReport solver;
};

/// Makes m UV maps harmonic, with the same periods: adds df to the forms du and dv as in Eq. 8 of the paper, with
/// L f = -d* du. That is step 5(c) of its § 9 applied to a coarser level. With a boundary, v keeps its values there and
/// u gets the natural condition, as for natural and Dirichlet forms. Free constants are chosen so that the mean of
/// `moves` is 0, each vertex weighted by a third of the area of its triangles.
/// @param corner_values #C x 2m, columns u, v, u, v, ...
/// @throws InvalidMesh naming an edge across which the map is not continued by a translation, or a boundary edge along
/// which v changes. TopologyError unless the surface is connected, with handles or two boundary loops. SolverError;
/// Cancelled
HarmonicMap harmonic_map(const mesh::Surface& surface, const forms::RowMajorMatrix& corner_values,
                         const structure::Options& options, Execution& execution);

}  // namespace holomorph::structure
