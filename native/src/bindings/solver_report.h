// A solver's report for Python.
#pragma once

#include <pybind11/pybind11.h>

#include "structure/solver_report.h"

namespace holomorph::bindings {

inline pybind11::tuple report(const structure::SolverReport& solver) {
  pybind11::list levels;
  for (const auto& level : solver.levels)
    levels.append(pybind11::make_tuple(level.faces, level.iterations, level.seconds));
  return pybind11::make_tuple(solver.name, solver.reason, solver.iterations, solver.residual, pybind11::tuple(levels));
}

}  // namespace holomorph::bindings
