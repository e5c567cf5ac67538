#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include "bindings/arrays.h"
#include "bindings/bindings.h"
#include "structure/laplace_problem.h"
#include "structure/solver_report.h"

namespace holomorph::bindings {
namespace {

using Problem = structure::LaplaceProblem;

std::shared_ptr<Problem> make(const mesh::Surface& surface, const std::vector<int>& fixed, const std::string& solver,
                              int threads) {
  const py::gil_scoped_release unlocked;
  Execution execution(threads);
  return std::make_shared<Problem>(structure::laplace_problem(surface, fixed, {solver}, execution));
}

// @param dirichlet one flag per column of B
py::array solve(Problem& problem, const Eigen::MatrixXd& B, const std::vector<bool>& dirichlet) {
  solver::Solution X;
  {
    const py::gil_scoped_release unlocked;
    std::vector<solver::Condition> conditions;
    for (const bool zero : dirichlet) {
      conditions.push_back(zero ? solver::Condition::dirichlet : solver::Condition::natural);
    }
    Execution execution(problem.threads);
    X = problem.solver->solve(B, conditions, execution);
  }
  return give_matrix(std::move(X));
}

structure::SolverReport report(const Problem& problem) {
  const auto& solver = *problem.solver;
  return {solver.name(), solver.remark(), solver.iterations(), solver.residual()};
}

Eigen::MatrixX2i ends(const Problem& problem) {
  const auto& all = problem.ends;
  return Eigen::Map<const Eigen::Matrix<int, Eigen::Dynamic, 2, Eigen::RowMajor>>(all.front().data(), all.size(), 2);
}

}  // namespace

void bind_laplace_problem(py::module_& m) {
  py::class_<Problem, std::shared_ptr<Problem>>(m, "LaplaceProblem")
      .def(py::init(&make), py::arg("surface"), py::arg("fixed"), py::arg("solver"), py::arg("threads"))
      .def("solve", &solve, py::arg("right_hand_sides"), py::arg("dirichlet"))
      .def("report", &report)
      .def("edges", [](const Problem& p) { return copy(ends(p)); })
      .def("weights", [](const Problem& p) { return copy(p.weights); });
}

}  // namespace holomorph::bindings
