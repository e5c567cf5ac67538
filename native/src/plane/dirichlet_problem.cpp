#include "plane/dirichlet_problem.h"

#include "forms/laplacian.h"
#include "solver/solver_choice.h"

namespace holomorph::plane {

DirichletSolution solve_dirichlet(const mesh::HalfEdges& half_edges, std::span<const double> weights,
                                  const std::vector<int>& fixed, const Eigen::MatrixXd& values,
                                  const structure::Options& options, Execution& execution) {
  const auto laplacian = forms::laplacian(half_edges, weights, execution);
  const auto L = laplacian.matrix();
  auto given = laplacian;
  const auto choice = solver::choose_method(options.solver, L.rows(), values.cols());
  const auto solver = solver::make_solver(choice.method, std::move(given), fixed, execution);
  DirichletSolution result;
  result.functions = values + solver->solve(-(L * values), solver::Condition::dirichlet, execution);
  Eigen::MatrixXd flux = L * result.functions;
  const double largest = (L.cwiseAbs() * result.functions.cwiseAbs()).maxCoeff();
  result.energies = result.functions.cwiseProduct(flux).colwise().sum().transpose();
  for (const int v : fixed) flux.row(v).setZero();
  result.harmonicity = flux.cwiseAbs().maxCoeff() / largest;
  result.solver = structure::solver_report(*solver, choice);
  return result;
}

}  // namespace holomorph::plane
