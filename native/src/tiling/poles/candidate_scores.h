// What candidates for poles are told apart by: quick to compute, and in the order of what it stands for.
#pragma once

#include <Eigen/Core>
#include <unordered_map>
#include <vector>

#include "tiling/greens/greens_functions.h"

namespace holomorph::tiling {

/// Variances of the logarithm of a density in single precision, by a polynomial; the floor is a bound, below a median
/// that is known to a quarter of an octave. Some 1e-3 from `unevenness`, at a tenth of its time.
class CandidateScores {
 public:
  /// @param every of the samples every so many-th is used. @pre the Green's functions outlive this
  CandidateScores(const GreensFunctions& greens, int every) : greens_(greens), every_(every) {}

  /// Looks up the Green's functions of these vertices. @pre they were solved for
  void prepare(const std::vector<int>& vertices);

  /// A on the samples used, of what is the same for all candidates. @param A on these samples
  /// @param median of a density that is near those of the candidates
  void set_rest(const VectorXcd& A, double median);

  /// The score of the rest and `residue` times the Green's function of a vertex. Threads may ask side by side.
  /// @pre `prepare` was called for the vertex
  double operator()(int vertex, Complex residue) const;

 private:
  const GreensFunctions& greens_;
  int every_;
  double scale_ = 1;                                  // that of the rest, which single precision is relative to
  Eigen::VectorXf rest_;                              // real parts above imaginary ones
  std::unordered_map<int, Eigen::VectorXf> columns_;  // likewise
};

}  // namespace holomorph::tiling
