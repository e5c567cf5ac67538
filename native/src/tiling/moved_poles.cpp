// Tiler: the last tiling with some of its poles elsewhere.
#include <Eigen/LU>
#include <cmath>
#include <string>

#include "base/errors.h"
#include "tiling/tiler.h"
#include "tiling/tiling_problem.h"

namespace holomorph::tiling {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

constexpr double kMakeUp = 0.1;  // how far poles may go that make up for others, in square roots of the area

Tiling Tiler::with_poles_moved(const std::vector<std::pair<int, int>>& moves, Execution& execution) {
  execution.stage("poles at their places", 0.0, 0.9);
  Candidate candidate = last_->candidate;
  const std::vector<Index> used = candidate.used();
  std::vector<char> moved(candidate.poles.vertices.size(), 0);
  for (const auto& [i, v] : moves) {
    if (i < 0 || i >= static_cast<int>(used.size()))
      throw TopologyError("there is no pole " + std::to_string(i) + ": the tiling has " + std::to_string(used.size()));
    if (!mesh::has_proper_star(*surface_, landscape_->half_edges(), v))
      throw TopologyError("vertex " + std::to_string(names_.empty() ? v : names_[v]) +
                          " cannot be a pole: its faces touch the boundary or themselves");
    moved[used[i]] = 1;
    candidate.poles.vertices[used[i]] = v;
  }
  const Index n = landscape_->form_count(), k = last_->problem.residues.rows();
  if (has_leverage())
    follow_with_leverage(candidate, moved);
  else if (n > 0)
    follow_with_boundary(candidate, execution);
  RoundingProblem there = last_->problem;
  there.forms.middleCols(n, k) = pole_forms(*landscape_, candidate.poles.vertices, execution);
  measure(there, candidate.rounding);
  return map_of(candidate, execution);
}

void Tiler::follow_with_leverage(Candidate& c, const std::vector<char>& moved) {
  VectorXcd periods = c.X;
  for (std::size_t i = 0; i < moved.size(); ++i) {
    VectorXd& part = c.poles.parts[i];
    periods -= c.residues[static_cast<Index>(i)] * part;
    if (moved[i]) part = nearest_representative(abel_jacobi_->at(c.poles.vertices[i]), part);
  }
  if (!chosen_) {
    const MatrixXcd metric = defect_metric(last_->problem) / std::sqrt(last_->tiles);
    c.poles = pole_moves_->moved(std::move(c.poles), periods, c.residues, metric, {allowed_, kMakeUp, moved});
  }
  c.X = periods;
  for (std::size_t i = 0; i < moved.size(); ++i) c.X += c.residues[static_cast<Index>(i)] * c.poles.parts[i];
  const VectorXcd split = pole_moves_->leverage().split(c.X);
  const Index n = landscape_->form_count();
  c.rounding.y.head(n) = split.head(n);
  c.rounding.y.tail(n) = split.tail(n);
}

void Tiler::follow_with_boundary(Candidate& c, Execution& execution) {
  const std::vector<Index> used = c.used();
  std::vector<int> vertices;
  for (const Index i : used) vertices.push_back(c.poles.vertices[i]);
  const auto s = structure_at(vertices, execution);
  const MatrixXd now = change_of_basis(landscape_->structure().topology.classes, *s).inverse() * s->pole_parts;
  const Index n = landscape_->form_count(), defects = last_->problem.defects.cols();
  VectorXcd change = VectorXcd::Zero(n);
  for (std::size_t i = 0; i < used.size(); ++i) {
    const VectorXd before = last_->parts.col(used[i]);
    change += c.residues[used[i]] * (nearest_representative(now.col(static_cast<Index>(i)), before) - before);
  }
  if (kind_ == uv::Coefficients::real) change.imag().setZero();
  c.X += change;
  c.rounding.y.head(n) = c.X;
  const MatrixXd& star = landscape_->structure().holomorphic.star.star;
  c.rounding.y.tail(defects) -= (star.transpose() * change.real()).head(defects);
}

}  // namespace holomorph::tiling
