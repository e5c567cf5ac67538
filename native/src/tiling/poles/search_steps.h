// The steps of a search for poles: one is added, or goes to where it does best beside the others.
#pragma once

#include <optional>
#include <vector>

#include "base/task_progress.h"
#include "mesh/ambient_occlusion.h"
#include "tiling/poles/candidate_scores.h"
#include "tiling/poles/pole_candidates.h"
#include "tiling/poles/pole_objective.h"

namespace holomorph::tiling {

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
