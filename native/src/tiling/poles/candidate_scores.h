// Scores that rank candidates for poles: quick to compute, and nearly in the order of their unevenness.
#pragma once

#include <Eigen/Core>
#include <unordered_map>
#include <vector>

#include "tiling/greens/greens_functions.h"

namespace holomorph::tiling {

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

}  // namespace holomorph::tiling
