// The steps of a search for poles: one is added, or goes to where it does best beside the others.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <unordered_map>
#include <vector>

#include "base/task_progress.h"
#include "mesh/triangle_tree.h"
#include "tiling/greens/pole_basis.h"
#include "tiling/poles/pole_candidates.h"
#include "tiling/poles/pole_objective.h"

namespace holomorph::tiling {

// Scores that rank candidates for poles: quick to compute, and nearly in the order of their unevenness.

/// Variances of the logarithm of a density, in single precision, the logarithm by a polynomial. Densities are cut off
/// below the floor, which is relative to a median from a histogram. Some 1e-3 from `unevenness`, in a tenth of its
/// time.
class CandidateScores {
 public:
  /// @param every stride of the samples that are used. @pre the functions outlive this
  CandidateScores(const GreensFunctions& greens, int every) : greens_(greens), every_(every) {}

  /// Looks up the Green's functions of these vertices. @pre they were solved for
  void prepare(const std::vector<int>& vertices);

  /// Sets the part of the form that all candidates share. @param A on the samples used
  /// @param median of a density near those of the candidates
  void set_rest(const VectorXcd& A, double median);

  /// Returns the score of the shared part plus `residue` times the Green's function of a vertex. Several
  /// threads may call it. @pre `prepare` was called for the vertex
  double operator()(int vertex, Complex residue) const;

 private:
  const GreensFunctions& greens_;
  int every_;
  double scale_ = 1;                                  // that of the rest, which single precision is relative to
  Eigen::VectorXf rest_;                              // real parts above imaginary ones
  std::unordered_map<int, Eigen::VectorXf> columns_;  // likewise
};

class SearchSteps {
 public:
  /// @param every stride of the samples that are used. @pre what is referred to outlives the steps
  SearchSteps(GreensFunctions& greens, const PlaceOptions& options, int every, Execution& execution);

 protected:
  static constexpr double kGain = 1e-3;  // less is no gain
  static inline const std::vector<double> kFromNear = {uv::kDensityFloor};

  /// Moves pole i to the candidate that does best. @return whether it moved
  bool exchange(MeromorphicForm& form, Index i);
  /// @return whether there was room
  bool add_one(MeromorphicForm& form);
  /// Adds the exposure of poles to the objective until end_hiding(). @param worth weight of their mean exposure
  /// @param share amount by which the objective may grow for each pole that moves
  void begin_hiding(const std::vector<int>& poles, double worth, double share);
  void end_hiding() { exposure_.reset(); }
  MeromorphicForm best_optimised(std::vector<MeromorphicForm> list, const std::vector<double>& floors);

  GreensFunctions& greens_;
  const PoleBasis& basis_;
  const PlaceOptions& options_;
  Execution& execution_;
  PoleCandidates candidates_;
  PoleObjective objective_;
  TaskProgress watch_;
  int every_;
  const PoleObjective::Tick tick_ = [this] { watch_(0); };  // on the calling thread

 private:
  struct Trial {
    double value;
    int vertex;
    Complex residue;
  };

  double price(const MeromorphicForm& form) const;
  std::vector<Trial> trials_everywhere(const MeromorphicForm& form);
  std::vector<MeromorphicForm> all_optimised(std::vector<MeromorphicForm> list, const std::vector<double>& floors);

  CandidateScores scores_;
  std::optional<mesh::AmbientOcclusion> exposure_;  // while poles are hidden
  double weight_ = 0;                               // of its mean, beside the objective
  double share_ = 0, limit_ = 0;  // by what the objective may grow for a pole, and up to which it may now
};

}  // namespace holomorph::tiling
