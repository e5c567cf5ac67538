// What candidates for poles are told apart by: quick to compute, and in the order of what it stands for.
#pragma once

#include <Eigen/Core>
#include <unordered_map>
#include <vector>

#include "tiling/greens/greens_functions.h"
#include "tiling/poles/mirror.h"

namespace holomorph::tiling {

/// Variances of the logarithm of a density, in single precision, by a polynomial. The floor is a bound below the
/// median, which is known to a quarter of an octave. Some 1e-3 from `unevenness`, at a tenth of its time.
class CandidateScores {
 public:
  /// @param every of the samples every so many-th is used. @param mirror null, or each pole comes with its image
  /// @pre these outlive this
  CandidateScores(const GreensFunctions& greens, int every, const Mirror* mirror = nullptr)
      : greens_(greens), every_(every), mirror_(mirror) {}

  /// Looks up the Green's functions of these vertices, and of their images. @pre they were solved for
  void prepare(const std::vector<int>& vertices);

  /// A on the samples used, of what is the same for all candidates. @param A on these samples
  /// @param median of a density that is near those of the candidates
  void set_rest(const VectorXcd& A, double median);

  /// The score of the rest and `residue` times the Green's function of a vertex, and its conjugate at the image.
  /// Threads may ask side by side.
  /// @pre `prepare` was called for the vertex
  double operator()(int vertex, Complex residue) const;

 private:
  const GreensFunctions& greens_;
  int every_;
  const Mirror* mirror_;
  double scale_ = 1;                                  // that of the rest, which single precision is relative to
  Eigen::VectorXf rest_;                              // real parts above imaginary ones
  std::unordered_map<int, Eigen::VectorXf> columns_;  // likewise
};

}  // namespace holomorph::tiling
