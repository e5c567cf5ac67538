#include "tiling/moved_poles.h"

#include <Eigen/LU>
#include <cmath>
#include <string>

#include "base/errors.h"
#include "tiling/seamless_map.h"

namespace holomorph::tiling {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

std::vector<char> put(const std::vector<PoleMove>& moves, const Landscape& landscape, const std::vector<int>& names,
                      Candidate& candidate) {
  const std::vector<Index> used = candidate.used();
  std::vector<char> moved(candidate.poles.vertices.size(), 0);
  for (const auto& [i, v] : moves) {
    if (i < 0 || i >= static_cast<int>(used.size()))
      throw TopologyError("there is no pole " + std::to_string(i) + ": the tiling has " + std::to_string(used.size()));
    if (!mesh::has_proper_star(landscape.surface(), landscape.half_edges(), v))
      throw TopologyError("vertex " + std::to_string(names.empty() ? v : names[v]) +
                          " cannot be a pole: its faces touch the boundary or themselves");
    moved[used[i]] = 1;
    candidate.poles.vertices[used[i]] = v;
  }
  return moved;
}

void follow_with_leverage(const Choice& before, const AbelJacobi& abel_jacobi, const PoleMoves& pole_moves,
                          const MoveRules& rules, const std::vector<char>& moved, Candidate& c) {
  VectorXcd periods = c.X;
  for (std::size_t i = 0; i < moved.size(); ++i) {
    VectorXd& part = c.poles.parts[i];
    periods -= c.residues[static_cast<Index>(i)] * part;
    if (moved[i]) part = nearest_representative(abel_jacobi.at(c.poles.vertices[i]), part);
  }
  const MatrixXcd metric = defect_metric(before.problem) / std::sqrt(before.tiles);
  c.poles = pole_moves.moved(std::move(c.poles), periods, c.residues, metric, rules);
  c.X = periods;
  for (std::size_t i = 0; i < moved.size(); ++i) c.X += c.residues[static_cast<Index>(i)] * c.poles.parts[i];
  const VectorXcd split = pole_moves.leverage().split(c.X);
  const Index n = split.size() / 2;
  c.rounding.y.head(n) = split.head(n);
  c.rounding.y.tail(n) = split.tail(n);
}

void follow_with_boundary(const Choice& before, const Landscape& landscape, const structure::Structure& now, bool real,
                          Candidate& c) {
  const structure::Structure& plain = landscape.structure();
  const MatrixXd parts = change_of_basis(plain.topology.classes, now).inverse() * now.poles->harmonic_part;
  VectorXcd change = VectorXcd::Zero(parts.rows());
  const std::vector<Index> used = c.used();
  for (std::size_t i = 0; i < used.size(); ++i) {
    const VectorXd there = before.parts.col(used[i]);
    change += c.residues[used[i]] * (nearest_representative(parts.col(static_cast<Index>(i)), there) - there);
  }
  if (real) change.imag().setZero();
  c.X += change;
  c.rounding.y.head(c.X.size()) = c.X;
  const Index defects = before.problem.defects.cols();
  c.rounding.y.tail(defects) -= (plain.holomorphic().star.star.transpose() * change.real()).head(defects);
}

}  // namespace holomorph::tiling
