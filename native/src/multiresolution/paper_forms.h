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
// collapsed into: eta remains an integer class, and f(v_t) = f(v_s).
#pragma once

#include "base/execution.h"
#include "multiresolution/paper_levels.h"
#include "solver/conjugate_gradients.h"
#include "structure/solver_report.h"

namespace holomorph::multiresolution {

struct PaperOptions {
  double ratio = 4;                     ///< faces of a threshold over those of the one before
  std::int64_t least_faces = 500;       ///< fewest faces of a threshold above M0
  double level_residual = 1e-4;         ///< relative, goal on M0 and at the thresholds
  double residual = solver::kResidual;  ///< relative, goal on M
  solver::Scaling scaling = solver::Scaling::diagonal;
};

/// Numbers of splits of M0 and of the thresholds, ascending, without that of M.
std::vector<int> thresholds(const PaperLevels& levels, const PaperOptions& options);

struct PaperForms {
  forms::RowMajorMatrix functions;  ///< #V x #forms
  structure::SolverReport solver;
};

/// Steps 4 and 5: the initial guess on M; its report has all levels but M. A threshold's residual need not be small:
/// simplification changes the solution by some thousandths from one level to the next.
PaperForms paper_estimation(const PaperLevels& levels, const PaperOptions& options, Execution& execution);

/// Steps 4 to 6: functions f of the harmonic forms eta + df, eta the classes of `levels.bases`.
/// @param laplacian,B of the surface, in its own numbering: L f = B
/// @throws SolverError if the residual is not reached; Cancelled
PaperForms paper_forms(const PaperLevels& levels, const solver::Laplacian& laplacian, const Eigen::MatrixXd& B,
                       const PaperOptions& options, Execution& execution);

}  // namespace holomorph::multiresolution
