// The search for poles of even density: steps that add, move, relocate and prune them.
#pragma once

#include <algorithm>
#include <vector>

#include "base/watch.h"
#include "tiling/poles/candidate_scores.h"
#include "tiling/poles/orbits.h"
#include "tiling/poles/pole_candidates.h"
#include "tiling/poles/pole_objective.h"

namespace holomorph::tiling {

/// The least number of poles that a form needs.
int least_count(const PoleBasis& basis);

/// With a mirror every step is one of an orbit: of a pole on the plane, or of a pair.
class PoleSearch {
 public:
  /// @param every of the samples every so many-th is used. @pre what is referred to outlives the search
  PoleSearch(GreensFunctions& greens, const PlaceOptions& options, int every, Execution& execution);

  /// The fixed poles, or as few as there can be.
  MeromorphicForm begin();
  /// Adds poles up to `count`, one by one where they help most. @return whether there was room for so many; with a
  /// mirror for one less
  bool add(MeromorphicForm& form, int count);
  /// Moves each pole in turn to where it does best beside the others. @return whether one moved
  bool sweep(MeromorphicForm& form);
  /// Moves poles, and takes them away and adds them anew, until nothing is gained; their number stays.
  MeromorphicForm settled(MeromorphicForm form);
  /// Places extra poles and keeps the best, where that is more even: another optimum, which relocating one pole after
  /// the other does not reach. @pre more than a few poles
  MeromorphicForm pruned(MeromorphicForm form);
  double spread_of(const MeromorphicForm& form) const { return spread(density(form, greens_)); }

 private:
  struct Trial {
    double value;
    int vertex;
    Complex residue;
  };

  void refit(MeromorphicForm& form);
  bool is_fixed(int vertex) const { return std::ranges::find(options_.fixed, vertex) != options_.fixed.end(); }
  void sweep_to_the_end(MeromorphicForm& form);
  bool relocate(MeromorphicForm& form);
  void fill(MeromorphicForm& form, int count);
  bool exchange(MeromorphicForm& form, Index i);
  bool add_one(MeromorphicForm& form, int most);
  Index orbit_size(const MeromorphicForm& form, Index i) const {
    return tiling::orbit_size(form.poles, i, options_.mirror);
  }
  bool is_on_plane(int vertex) const { return options_.mirror && options_.mirror->is_on_plane(vertex); }
  bool is_pair(int vertex) const { return options_.mirror && !options_.mirror->is_on_plane(vertex); }
  std::vector<Trial> trials_everywhere(const MeromorphicForm& form);
  std::vector<MeromorphicForm> all_optimised(std::vector<MeromorphicForm> list, const std::vector<double>& floors);
  MeromorphicForm best_optimised(std::vector<MeromorphicForm> list, const std::vector<double>& floors);

  GreensFunctions& greens_;
  const PoleBasis& basis_;
  const PlaceOptions& options_;
  Execution& execution_;
  PoleCandidates candidates_;
  int every_;
  PoleObjective objective_;
  CandidateScores scores_;
  Watch watch_;
  const PoleObjective::Tick tick_ = [this] { watch_(0); };  // on the calling thread
};

}  // namespace holomorph::tiling
