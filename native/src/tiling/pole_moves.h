// Jacobi inversion: poles move until nothing is left over of the rounding, and go to vertices like a vernier.
#pragma once

#include <vector>

#include "tiling/abel_jacobi.h"
#include "tiling/leverage.h"

namespace holomorph::tiling {

/// Poles of a closed surface with handles at vertices, and the harmonic parts C there that the periods are meant with.
struct PlacedPoles {
  std::vector<int> vertices;
  std::vector<Eigen::VectorXd> parts;  ///< C at each, 2g
};

struct MoveRules {
  std::vector<char> allowed;  ///< #V, empty: anywhere
  double most = 0.12;         ///< how far a pole may go, in square roots of the area
  std::vector<char> held;     ///< #poles: those that stay at their vertices; empty: none
};

class PoleMoves {
 public:
  /// The landscape and the map outlive this.
  PoleMoves(const Landscape& landscape, const AbelJacobi& abel_jacobi);

  const Leverage& leverage() const { return leverage_; }

  /// g x g: the covariance of the t that moving these poles by about 1 takes up.
  Eigen::MatrixXcd reach(const std::vector<int>& vertices, const Eigen::VectorXcd& residues) const;

  /// Newton's method with the poles anywhere on the surface until t vanishes, or as small as it becomes; then one pole
  /// after the other goes to its nearest vertex, the one of highest leverage first, and the others follow; at last
  /// pairs of poles are exchanged for better pairs of vertices near them.
  /// @param metric g x g, R with |R t| the left-over that counts
  PlacedPoles moved(PlacedPoles poles, const Eigen::VectorXcd& periods, const Eigen::VectorXcd& residues,
                    const Eigen::MatrixXcd& metric, const MoveRules& rules) const;

 private:
  const Landscape& landscape_;
  const AbelJacobi& abel_jacobi_;
  Leverage leverage_;
};

}  // namespace holomorph::tiling
