// The search for poles of even density: steps that add, move, relocate and prune them.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "tiling/poles/search_steps.h"

namespace holomorph::tiling {

/// Returns the least number of poles that a form on this surface needs.
int least_count(const PoleBasis& basis);

class PoleSearch : private SearchSteps {
 public:
  using SearchSteps::SearchSteps;

  /// Returns the best form with the fixed poles or, without any, with as few poles as possible.
  MeromorphicForm begin();
  /// Adds poles up to `count`, one by one where they help most. @return whether there was room for all; with a
  /// mirror one may be missing
  bool add(MeromorphicForm& form, int count);
  /// Moves each pole in turn to where it does best beside the others. @return whether one moved
  bool sweep(MeromorphicForm& form);
  /// Moves poles, and removes those that matter least and adds them anew. Ends where nothing is gained, or the spread
  /// is small enough. Their number stays.
  MeromorphicForm settled(MeromorphicForm form, double enough = 0);
  /// Places extra poles and keeps the best, where that is more even. This reaches optima that relocating one pole after
  /// the other does not. @pre more than a few poles
  MeromorphicForm pruned(MeromorphicForm form);
  /// Moves each pole in turn to where it is less visible, while the objective grows by a tenth at most. That is a
  /// twentieth of the evened density's spread. @pre the surface has positions
  MeromorphicForm hidden(MeromorphicForm form);
  double spread_of(const MeromorphicForm& form) const { return spread(density(form, greens_)); }

 private:
  void refit(MeromorphicForm& form);
  bool is_fixed(int vertex) const { return std::ranges::find(options_.fixed, vertex) != options_.fixed.end(); }
  void fill(MeromorphicForm& form, int count);
  void sweep_to_the_end(MeromorphicForm& form);
  bool relocate(MeromorphicForm& form);
  std::optional<MeromorphicForm> least_missed(MeromorphicForm form, const std::vector<int>& stay, Index least);
};

}  // namespace holomorph::tiling
