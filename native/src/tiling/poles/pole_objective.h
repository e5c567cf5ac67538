// What poles are judged by: how even the density of the best form with them is, and what moving them can repair.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "tiling/greens/jacobian.h"
#include "tiling/poles/meromorphic_form.h"
#include "tiling/poles/mirror.h"

namespace holomorph::tiling {

class PoleObjective {
 public:
  using Tick = std::function<void()>;

  /// The Green's functions and the mirror outlive this. @param every of the samples every so many-th is used
  /// @param mirror null, or forms stay their own mirror image
  PoleObjective(GreensFunctions& greens, uv::Coefficients kind, int every = 1, const Mirror* mirror = nullptr);

  /// Solves for the Green's functions of these vertices, which the methods below look up.
  /// @param poles how many a form has that is judged. @throws SolverError, Cancelled
  void prepare(const std::vector<int>& vertices, Index poles, Execution& execution);

  /// Whether `optimise` keeps the ratios of the coefficients, as each costs as much as a pole; `fit` does not.
  bool has_many_forms() const;
  /// The best form with these poles, from the coefficients given, and its objective, as a search needs it
  /// (quick_variance.h). One for each floor of the density. @pre `prepare` was called for the poles, here and below
  /// @param tick called every few milliseconds; it may throw
  void optimise(MeromorphicForm& form, const std::vector<double>& floors, const Tick& tick) const;
  /// The same to double precision, with all coefficients free.
  void fit(MeromorphicForm& form, const std::vector<double>& floors, const Tick& tick) const;

  /// A on the samples used.
  VectorXcd samples_of(const MeromorphicForm& form) const;
  /// The metric of a density with which the Jacobian of so many poles is measured; empty where it does not count.
  MatrixXcd jacobian_metric(const ArrayXd& density, Index poles) const;
  /// What the Jacobian adds to the variance of the density.
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
  const Mirror* mirror_;
  MatrixXcd theta_;                   // A of the theta_j on the samples used
  std::optional<Jacobian> jacobian_;  // only on a closed surface with handles
  std::map<int, VectorXcd> tau_;
};

}  // namespace holomorph::tiling
