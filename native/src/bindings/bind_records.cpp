#include <pybind11/stl.h>

#include "bindings/arrays.h"
#include "bindings/bindings.h"
#include "bindings/records.h"
#include "structure/memory_plan.h"
#include "structure/solver_report.h"

namespace holomorph::bindings {

using structure::LevelReport;
using structure::MemoryPlan;
using structure::SolverReport;

void bind_records(py::module_& m) {
  py::class_<Zeros>(m, "Zeros")
      .def_property_readonly("vertices", [](const Zeros& z) { return copy(z.vertices); })
      .def_property_readonly("orders", [](const Zeros& z) { return copy(z.orders); });
  py::class_<Residuals>(m, "Residuals")
      .def_readonly("closedness", &Residuals::closedness)
      .def_readonly("harmonicity", &Residuals::harmonicity)
      .def_readonly("periods", &Residuals::periods)
      .def_readonly("pairing", &Residuals::pairing)
      .def_readonly("asymmetry", &Residuals::asymmetry);
  py::class_<LevelReport>(m, "LevelReport")
      .def_readonly("faces", &LevelReport::faces)
      .def_readonly("iterations", &LevelReport::iterations)
      .def_readonly("seconds", &LevelReport::seconds);
  py::class_<SolverReport>(m, "SolverReport")
      .def_readonly("name", &SolverReport::name)
      .def_readonly("reason", &SolverReport::reason)
      .def_readonly("iterations", &SolverReport::iterations)
      .def_readonly("residual", &SolverReport::residual)
      .def_readonly("levels", &SolverReport::levels);
  py::class_<MemoryPlan>(m, "MemoryPlan")
      .def_readonly("keeps_forms", &MemoryPlan::keep_forms)
      .def_readonly("block", &MemoryPlan::block)
      .def_readonly("bytes", &MemoryPlan::bytes);
}

}  // namespace holomorph::bindings
