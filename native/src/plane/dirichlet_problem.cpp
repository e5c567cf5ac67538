#include "plane/dirichlet_problem.h"

#include "forms/laplacian.h"
#include "solver/solver_choice.h"
#include "structure/refinement.h"

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
  auto given = laplacian;
  const auto choice = solver::choose_method(options.solver, L.rows(), values.cols());
  const auto solver = solver::make_solver(choice.method, std::move(given), fixed, execution);
  DirichletSolution result;
  forms::RowMajorMatrix functions = values + solver->solve(-(L * values), solver::Condition::dirichlet, execution);
  result.solver = structure::solver_report(*solver, choice);
  const bool stiff = structure::is_stiff(weights, execution.workers());
  if (stiff) {
    topology::IntegerForms no_classes;
    no_classes.rows.resize(weights.size());
    const std::vector<solver::Condition> conditions(values.cols(), solver::Condition::dirichlet);
    result.solver.residual =
        structure::refine({half_edges, weights, fixed}, {no_classes, 0, conditions}, functions, *solver, execution);
  }
  result.functions = functions;
  Eigen::MatrixXd flux = L * result.functions;
  const double largest = (L.cwiseAbs() * result.functions.cwiseAbs()).maxCoeff();
  result.energies = stiff ? energies(half_edges, weights, result.functions)
                          : Eigen::VectorXd(result.functions.cwiseProduct(flux).colwise().sum().transpose());
  for (const int v : fixed) flux.row(v).setZero();
  result.harmonicity = flux.cwiseAbs().maxCoeff() / largest;
  return result;
}

}  // namespace holomorph::plane
