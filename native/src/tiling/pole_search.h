// The search for poles of even density: steps that add, move, relocate and prune them.
#pragma once

#include <vector>

#include "tiling/landscape.h"
#include "tiling/pole_candidates.h"
#include "tiling/pole_objective.h"
#include "tiling/poles.h"

namespace holomorph::tiling {

/// The least number of poles that a form needs.
int least_count(const Landscape& landscape);

class PoleSearch {
 public:
  /// @param every of the samples every so many-th is used. @pre what is referred to outlives the search
  PoleSearch(Landscape& landscape, const PlacementRules& rules, int every, Execution& execution);

  /// The fixed poles, or as few as there can be.
  Poles begin();
  /// Up to `count`, one by one where they help most. @return whether there was room for so many
  bool add(Poles& poles, int count);
  /// Each in turn goes where it does best beside the others. @return whether one moved
  bool sweep(Poles& poles);
  /// The same number of poles at better places: moved, and taken away and added anew, until nothing is gained.
  Poles settled(Poles poles);
  /// Of some more poles those that matter, where that is more even: another optimum, which relocating one pole after
  /// the other does not reach. @pre more than a few poles
  Poles pruned(Poles poles);
  double spread_of(const Poles& poles) const { return spread(density(landscape_, poles, execution_)); }

 private:
  struct Trial {
    double value;
    int vertex;
    std::complex<double> residue;
  };

  bool is_fixed(int vertex) const;
  void sweep_to_the_end(Poles& poles);
  bool relocate(Poles& poles);
  bool exchange(Poles& poles, Eigen::Index i);
  bool add_one(Poles& poles);
  Poles without_last(Poles poles) const;
  Poles joined(const Poles& poles, const Trial& trial) const;
  std::vector<Trial> trials_everywhere(const Poles& poles);
  Poles best_optimised(std::vector<Poles> list, const std::vector<double>& floors);

  Landscape& landscape_;
  const PlacementRules& rules_;
  Execution& execution_;
  PoleCandidates candidates_;
  int every_;
  PoleObjective objective_;
};

}  // namespace holomorph::tiling
