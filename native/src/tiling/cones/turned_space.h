// The maps with given frames: their whole numbers, and functions beside them.
#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "linear/reduction.h"
#include "tiling/cones/transitions.h"
#include "uv/turned_functions.h"

namespace holomorph::tiling {

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

/// The maps with the transitions of frames. Around a vertex that is no cone the transitions are the identity. So the
/// translations of the cut's segments are integer combinations N z of free whole numbers z. At the corner c of vertex v
///     x(c) = R^turn(c) y(v) + offset(c) z,  in coordinates of the lattice,
/// where y(v) is any number, and 0 at a cone, which lies at a centre of the turns by itself. Along a line one part of x
/// is one number: an unknown that its vertices share, or a whole one.
struct TurnedSpace {
  TurnLattice lattice;
  std::vector<int> corner_turn;                         ///< #sides, of the corner that the side leaves
  Eigen::SparseMatrix<double, Eigen::RowMajor> offset;  ///< 2 #sides x #z
  uv::Unknowns unknowns;                                ///< the parts of y
  std::vector<int> segment;                             ///< #sides, -1 off the cut; a side and its twin have the same
  std::vector<char> along_segment;                      ///< #sides, whether translations are as given or inverted
  linear::IntegerMatrix translations;                   ///< 2 #segments x #z

  /// The translation across a cut side, from its triangle to the twin's. @param turn Frames::turn of the side
  Eigen::Matrix<std::int64_t, 2, 1> translation(int side, int turn, const linear::IntegerVector& z) const;
};

/// @param whole_lines whether lines of the net have whole numbers: rows of tiles end at them; otherwise any
TurnedSpace make_space(const Net& net, const Frames& frames, int k, const std::vector<int>& missing, bool whole_lines);

}  // namespace holomorph::tiling
