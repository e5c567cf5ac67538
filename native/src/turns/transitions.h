// How a turned map continues across edges: the connection with the wanted cones, its cut, and whole numbers.
#pragma once

#include <vector>

#include "lattice/reduction.h"
#include "turns/laplace.h"
#include "turns/net.h"

namespace holomorph::turns {

/// 2 x 2 integers: a turn of the lattice in its own coordinates, or a multiple of one.
using Turn = Eigen::Matrix<int, 2, 2>;

/// The lattice whose symmetry the turns are.
struct TurnLattice {
  explicit TurnLattice(int k);

  /// The r-th power of the turn by 2 pi / k, also for negative r.
  const Turn& power(int r) const { return powers[((r % k) + k) % k]; }
  Complex at(double a, double b) const { return a + b * second; }

  int k;
  Complex second;            ///< the vectors of the lattice are 1 and this
  std::vector<Turn> powers;  ///< k
};

/// A flat metric with cones, its log scale u and its directions: frame theta on each triangle, so that u of the map
/// runs at the angle theta in the triangle's plane. Frames continue across edges but for turns.
struct Frames {
  Eigen::VectorXd scale;      ///< #V, u
  std::vector<double> angle;  ///< #T, theta
  /// #sides: across a cut edge x' = R^turn x + translation, from the triangle to the twin's; -1 for an edge that is not
  /// cut
  std::vector<int> turn;
};

/// @param missing #V, cones (cones.h). @throws SolverError
Frames make_frames(const mesh::Surface& surface, const Net& net, int k, const std::vector<int>& missing);

/// The maps with the transitions of frames. Around a vertex that is no cone the transitions are the identity. So the
/// translations of the cut's segments are integer combinations N z of free whole numbers z. At the corner c of vertex v
///     x(c) = R^turn(c) y(v) + offset(c) z,  in coordinates of the lattice,
/// where y(v) is any number, and 0 at a cone, which lies at a centre of the turns by itself.
struct TurnedSpace {
  TurnLattice lattice;
  std::vector<int> corner_turn;                         ///< #sides, of the corner that the side leaves
  Eigen::SparseMatrix<double, Eigen::RowMajor> offset;  ///< 2 #sides x #z
  std::vector<char> is_fixed;                           ///< #V, whether y is 0: at cones, or without any at one vertex
  std::vector<int> segment;                             ///< #sides, -1 off the cut; a side and its twin have the same
  std::vector<char> along_segment;                      ///< #sides, whether translations are as given or inverted
  lattice::IntegerMatrix translations;                  ///< 2 #segments x #z

  /// The translation across a cut side, from its triangle to the twin's. @param turn Frames::turn of the side
  Eigen::Matrix<std::int64_t, 2, 1> translation(int side, int turn, const lattice::IntegerVector& z) const;
};

TurnedSpace make_space(const Net& net, const Frames& frames, int k, const std::vector<int>& missing);

}  // namespace holomorph::turns
