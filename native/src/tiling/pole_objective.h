// What poles are judged by: how even the density of the best form with them is, and what moving them can repair.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "tiling/leverage.h"
#include "tiling/poles.h"

namespace holomorph::tiling {

class PoleObjective {
 public:
  /// The landscape outlives this. @param every of the samples every so many-th is used
  PoleObjective(Landscape& landscape, uv::Coefficients kind, int every = 1);

  /// The best form with these poles, from the coefficients given, and its value as `variance`; for each of the floors
  /// of the density in turn. @pre `prepare` was called for the poles
  void optimise(Poles& poles, const std::vector<double>& floors, Execution& execution) const;
  /// Solves for the forms of poles at these vertices, before threads look them up. @throws SolverError, Cancelled
  void prepare(const std::vector<int>& vertices, Execution& execution);

  /// A on the samples used.
  Eigen::VectorXcd form(const Poles& poles, Execution& execution) const;
  /// What the leverage adds to the variance of the density, with the metric of that density.
  Eigen::MatrixXcd leverage_metric(const Eigen::ArrayXd& density) const;
  double leverage_term(const std::vector<int>& vertices, const Eigen::VectorXcd& residues,
                       const Eigen::MatrixXcd& metric) const;

 private:
  Eigen::MatrixXcd columns(const std::vector<int>& vertices, Execution& execution) const;
  Eigen::VectorXcd unknowns(const Poles& poles) const;
  void set(const Eigen::VectorXcd& x, Poles& poles) const;

  Landscape& landscape_;
  uv::Coefficients kind_;
  int every_;
  Eigen::MatrixXcd theta_;            // A of the theta_j on the samples used
  std::optional<Leverage> leverage_;  // only on a closed surface with handles
  std::map<int, Eigen::VectorXcd> tau_;
};

}  // namespace holomorph::tiling
