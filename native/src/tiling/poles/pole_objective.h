// The objective of the search for poles: how uneven the density of the best form with them is, and how well moving them
// can cancel defects.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "tiling/inversion/abel_jacobi.h"
#include "tiling/poles/meromorphic_form.h"

namespace holomorph::tiling {

class PoleObjective {
 public:
  using Tick = std::function<void()>;

  /// @pre the Green's functions outlive this. @param every stride of the samples that are used
  PoleObjective(GreensFunctions& greens, uv::Coefficients kind, int every = 1);

  /// Solves for the Green's functions of these vertices, which the methods below look up.
  /// @param poles number of poles of the forms to be judged. @throws SolverError, Cancelled
  void prepare(const std::vector<int>& vertices, Index poles, Execution& execution);

  /// Whether there are many holomorphic forms, so that `optimise` keeps the ratios of their coefficients, each of which
  /// costs as much as a pole. `fit` changes them all.
  bool has_many_forms() const;
  /// Finds the best form with these poles, from the coefficients given, and its objective, to the accuracy of a search
  /// (search_steps.h). Descends once for each floor of the density. @pre `prepare` was called for the poles, here
  /// and below
  /// @param tick called every few milliseconds; it may throw
  void optimise(MeromorphicForm& form, const std::vector<double>& floors, const Tick& tick) const;
  /// Does the same to double precision, with all coefficients free.
  void fit(MeromorphicForm& form, const std::vector<double>& floors, const Tick& tick) const;

  /// Returns A on the samples used.
  VectorXcd samples_of(const MeromorphicForm& form) const;
  /// Returns the metric in which the Jacobian of this number of poles is measured, for a form of this density; empty
  /// where the Jacobian does not count.
  MatrixXcd jacobian_metric(const ArrayXd& density, Index poles) const;
  /// Returns the term that the Jacobian adds to the variance of the density.
  double jacobian_term(const std::vector<int>& vertices, const VectorXcd& residues, const MatrixXcd& metric) const;

 private:
  bool has_jacobian(Index poles) const;
  MatrixXcd columns(const MatrixXcd& forms, const std::vector<int>& vertices) const;
  void descend(const MatrixXcd& forms, MeromorphicForm& form, const std::vector<double>& floors, int steps,
               const Tick& tick) const;
  void descend_quickly(const MatrixXcd& forms, MeromorphicForm& form, const std::vector<double>& floors,
                       const Tick& tick) const;
  VectorXcd unknowns(const MeromorphicForm& form) const;
  void set(const VectorXcd& x, MeromorphicForm& form) const;

  GreensFunctions& greens_;
  uv::Coefficients kind_;
  int every_;
  MatrixXcd theta_;                   // A of the theta_j on the samples used
  std::optional<Jacobian> jacobian_;  // only on a closed surface with handles
  std::map<int, VectorXcd> tau_;
};

}  // namespace holomorph::tiling
