#include "plane/dirichlet_problem.h"

#include "forms/laplacian.h"
#include "forms/refined_solver.h"

namespace holomorph::plane {

Eigen::VectorXd energies(const mesh::HalfEdges& half_edges, std::span<const double> weights,
                         const Eigen::MatrixXd& functions) {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(functions.cols());
  for (int e = 0; e < static_cast<int>(weights.size()); ++e) {
    const int head = mesh::to_vertex(half_edges, mesh::HalfedgeHandle(2 * e)),
              tail = mesh::to_vertex(half_edges, mesh::HalfedgeHandle(2 * e + 1));
    result += weights[e] * (functions.row(head) - functions.row(tail)).cwiseAbs2().transpose();
  }
  return result;
}

DirichletSolution solve_dirichlet(const mesh::HalfEdges& half_edges, std::span<const double> weights,
                                  const std::vector<int>& fixed, const Eigen::MatrixXd& values,
                                  const structure::Options& options, Execution& execution) {
  const auto laplacian = forms::laplacian(half_edges, weights, execution);
  const auto L = laplacian.matrix();
  const auto choice = solver::choose_method(options.solver, L.rows(), values.cols());
  auto given = laplacian;
  forms::RefinedSolver solver(half_edges, weights, fixed, choice,
                              solver::make_solver(choice.method, std::move(given), fixed, execution),
                              execution.workers());
  DirichletSolution result;
  result.functions = values + solver.solve(
                                  -(L * values), solver::Condition::dirichlet,
                                  [&] { return forms::function_terms(half_edges, values); }, execution);
  result.solver = structure::solver_report(solver);
  for (const int v : fixed) result.functions.row(v) = values.row(v);  // exactly
  Eigen::MatrixXd flux = L * result.functions;
  const double largest = (L.cwiseAbs() * result.functions.cwiseAbs()).maxCoeff();
  result.energies = solver.is_stiff()
                        ? energies(half_edges, weights, result.functions)
                        : Eigen::VectorXd(result.functions.cwiseProduct(flux).colwise().sum().transpose());
  for (const int v : fixed) flux.row(v).setZero();
  result.harmonicity = flux.cwiseAbs().maxCoeff() / largest;
  return result;
}

}  // namespace holomorph::plane
