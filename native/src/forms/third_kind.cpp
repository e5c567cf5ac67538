#include "forms/third_kind.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace holomorph::forms {
namespace {

using mesh::edge_of;
using mesh::HalfedgeHandle;
using mesh::HalfEdges;
using mesh::sign;
using mesh::to_vertex;

// Values along half-edge 2e of the form d f + sum_i residues(i) n_i.
Eigen::RowVectorXd along(const HalfEdges& mesh, const Singularities& s, const Eigen::MatrixXd& f, int e) {
  Eigen::RowVectorXd value =
      f.row(to_vertex(mesh, HalfedgeHandle(2 * e))) - f.row(to_vertex(mesh, HalfedgeHandle(2 * e + 1)));
  for (const auto& [i, n] : s.classes.rows[e]) value += n * s.residues.row(i);
  return value;
}

Eigen::RowVectorXd difference(const HalfEdges& mesh, const Eigen::MatrixXd& f, int e) {
  return f.row(to_vertex(mesh, HalfedgeHandle(2 * e))) - f.row(to_vertex(mesh, HalfedgeHandle(2 * e + 1)));
}

// The right-hand sides, u in the first m columns, v in the others.
Eigen::MatrixXd right_hand_sides(const HalfEdges& mesh, const Singularities& s) {
  const auto m = s.residues.cols();
  Eigen::MatrixXd B(s.part.u.rows(), 2 * m);
  B << s.part.b_u, s.part.b_v;
  Eigen::RowVectorXd flux(2 * m);
  for (int e = 0; e < static_cast<int>(s.outer_weights.size()); ++e) {
    flux << along(mesh, s, s.part.u, e), difference(mesh, s.part.v, e);
    flux *= s.outer_weights[e];
    B.row(to_vertex(mesh, HalfedgeHandle(2 * e))) -= flux;
    B.row(to_vertex(mesh, HalfedgeHandle(2 * e + 1))) += flux;
  }
  return B;
}

// Largest |B - L X| at a vertex over the largest sum of the terms; the rows of v at held vertices are no equations.
double relative_residual(const HalfEdges& mesh, std::span<const double> weights, const Eigen::MatrixXd& B,
                         const Eigen::MatrixXd& X, const std::vector<int>& held) {
  Eigen::MatrixXd rest = B, size = B.cwiseAbs();
  for (int e = 0; e < static_cast<int>(weights.size()); ++e) {
    const int head = to_vertex(mesh, HalfedgeHandle(2 * e)), tail = to_vertex(mesh, HalfedgeHandle(2 * e + 1));
    const Eigen::RowVectorXd flux = weights[e] * difference(mesh, X, e);
    rest.row(head) -= flux;
    rest.row(tail) += flux;
    size.row(head) += flux.cwiseAbs();
    size.row(tail) += flux.cwiseAbs();
  }
  for (const int v : held) rest.row(v).tail(rest.cols() / 2).setZero();
  return (rest.cwiseAbs().colwise().maxCoeff().array() / size.colwise().maxCoeff().array()).maxCoeff();
}

}  // namespace

ThirdKind third_kind(const HalfEdges& mesh, std::span<const double> weights, const Singularities& s,
                     solver::LaplaceSolver& solver, const std::vector<int>& held, Execution& execution) {
  const auto m = s.residues.cols();
  const Eigen::MatrixXd B = right_hand_sides(mesh, s);
  std::vector<solver::Condition> conditions(2 * m, solver::Condition::natural);
  if (!held.empty()) std::fill(conditions.begin() + m, conditions.end(), solver::Condition::dirichlet);
  const Eigen::MatrixXd X = solver.solve(B, conditions, execution);
  return {s.part.u + X.leftCols(m), s.part.v + X.rightCols(m), relative_residual(mesh, weights, B, X, held)};
}

Eigen::MatrixXd harmonic_part(const HalfEdges& mesh, const Singularities& s, const std::vector<mesh::Star>& stars,
                              const ClosedForms& harmonic, const Eigen::MatrixXd& gram_matrix) {
  Eigen::MatrixXd P = Eigen::MatrixXd::Zero(gram_matrix.rows(), s.residues.cols());
  for (int e = 0; e < static_cast<int>(s.outer_weights.size()); ++e) {
    const Eigen::RowVectorXd u = along(mesh, s, s.part.u, e);
    if (u.isZero(0)) continue;
    P += s.outer_weights[e] * edge_values(mesh, harmonic, e, e + 1).transpose() * u;
  }
  for (const mesh::Star& star : stars) {
    for (const HalfedgeHandle h : star.link) {
      const HalfedgeHandle spoke = mesh::next(mesh, h);  // towards the puncture
      const RowMajorMatrix inwards = sign(spoke) * edge_values(mesh, harmonic, edge_of(spoke), edge_of(spoke) + 1);
      P += inwards.transpose() * s.part.b_u.row(to_vertex(mesh, h));
    }
  }
  return gram_matrix.llt().solve(P);
}

}  // namespace holomorph::forms
