#include "flat/dirichlet_problem.h"

#include "forms/laplacian.h"

namespace holomorph::flat {
namespace {

forms::RefinedSolver refined_solver(const mesh::Discretisation& discretisation, const std::vector<int>& fixed,
                                    solver::Laplacian laplacian, int columns, const structure::Options& options,
                                    Execution& execution) {
  const auto choice = solver::choose_method(options.solver, laplacian.size(), columns);
  return {discretisation.half_edges,
          discretisation.weights,
          fixed,
          choice,
          solver::make_solver(choice.method, std::move(laplacian), fixed, execution),
          execution.workers()};
}

}  // namespace

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

DirichletProblem::DirichletProblem(const mesh::Discretisation& discretisation, const std::vector<int>& fixed,
                                   int columns, const structure::Options& options, Execution& execution)
    : discretisation_(discretisation),
      fixed_(fixed),
      laplacian_(forms::laplacian(discretisation.half_edges, discretisation.weights, execution)),
      solver_(refined_solver(discretisation, fixed, laplacian_, columns, options, execution)) {}

DirichletSolution DirichletProblem::harmonic(const Eigen::MatrixXd& values, Execution& execution) {
  const auto L = laplacian_.matrix();
  DirichletSolution result;
  // f = values + g, with g = 0 at the fixed vertices and L g = -L values at the free ones.
  result.functions = values + solver_.solve(
                                  -(L * values), solver::Condition::dirichlet,
                                  [&] { return forms::function_terms(discretisation_.half_edges, values); }, execution);
  result.solver = structure::solver_report(solver_);
  for (const int v : fixed_) result.functions.row(v) = values.row(v);  // exactly
  Eigen::MatrixXd flux = L * result.functions;
  const double largest = (L.cwiseAbs() * result.functions.cwiseAbs()).maxCoeff();
  // f . L f cancels where weights are large. Differences first, it does not.
  result.energies = solver_.is_stiff()
                        ? energies(discretisation_.half_edges, discretisation_.weights, result.functions)
                        : Eigen::VectorXd(result.functions.cwiseProduct(flux).colwise().sum().transpose());
  for (const int v : fixed_) flux.row(v).setZero();
  result.harmonicity = flux.cwiseAbs().maxCoeff() / largest;
  return result;
}

Eigen::MatrixXd DirichletProblem::poisson(const Eigen::MatrixXd& sources, Execution& execution) {
  return solver_.solve(
      sources, solver::Condition::dirichlet, [&] { return forms::FluxTerms{.sources = sources}; }, execution);
}

DirichletSolution solve_dirichlet(const mesh::Discretisation& discretisation, const std::vector<int>& fixed,
                                  const Eigen::MatrixXd& values, const structure::Options& options,
                                  Execution& execution) {
  DirichletProblem problem(discretisation, fixed, static_cast<int>(values.cols()), options, execution);
  return problem.harmonic(values, execution);
}

}  // namespace holomorph::flat
