// A tiling with some of its poles elsewhere: the residues stay, and so do the periods, but that a pole's way around a
// handle is taken for the shortest.
#pragma once

#include <vector>

#include "tiling/abel_jacobi.h"
#include "tiling/candidate.h"

namespace holomorph::tiling {

/// What a tiling was made of.
struct Choice {
  Candidate candidate;
  RoundingProblem problem;
  Eigen::MatrixXd parts;  ///< with boundary, of the poles of the problem
  TextureLattice lattice;
  double tiles = 0;
};

struct PoleMove {
  int pole = 0;  ///< among those that are used
  int vertex = 0;
};

/// Puts poles at their new vertices. @return for each pole whether it was moved. @throws TopologyError
std::vector<char> put(const std::vector<PoleMove>& moves, const Landscape& landscape, const std::vector<int>& names,
                      Candidate& candidate);

/// What follows on a closed surface with handles. The others make up for what is left over.
/// @param rules which poles are held; without any that is not, the tiling is what it becomes
void follow_with_leverage(const Choice& before, const AbelJacobi& abel_jacobi, const PoleMoves& pole_moves,
                          const MoveRules& rules, const std::vector<char>& moved, Candidate& candidate);

/// What follows with boundary. @param now structure with the used poles where they are
void follow_with_boundary(const Choice& before, const Landscape& landscape, const structure::Structure& now, bool real,
                          Candidate& candidate);

}  // namespace holomorph::tiling
