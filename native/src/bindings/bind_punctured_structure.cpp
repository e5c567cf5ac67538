#include <pybind11/complex.h>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <memory>

#include "bindings/arrays.h"
#include "bindings/bindings.h"
#include "bindings/callback.h"
#include "pipeline/punctured_structure.h"
#include "pipeline/sphere_map.h"

namespace holomorph::bindings {
namespace {

using pipeline::PuncturedStructure;

std::shared_ptr<PuncturedStructure> compute(const mesh::Surface& surface, const std::vector<int>& vertices,
                                            const std::vector<std::complex<double>>& residues,
                                            const std::vector<int>& names, const std::string& solver, int threads,
                                            const py::object& progress_function) {
  Execution execution(threads, callback(progress_function));
  const py::gil_scoped_release unlocked;
  return std::make_shared<PuncturedStructure>(
      pipeline::punctured_structure(surface, {vertices, residues, names}, {solver, threads}, execution));
}

py::array uv(const PuncturedStructure& s, const Eigen::VectorXcd& c) {
  uv::UvArray result;
  {
    const py::gil_scoped_release unlocked;
    Workers workers;
    result = pipeline::uv_map(s, c, workers);
  }
  return give_matrix(std::move(result));
}

// Takes the sheets of the caller's cut instead of our own; the spokes of the punctures are cut in any case.
void cut_along(PuncturedStructure& s, std::vector<int> edges, const std::vector<int>& names) {
  const py::gil_scoped_release unlocked;
  for (const mesh::Star& star : s.stars) {
    for (const auto h : star.link) edges.push_back(mesh::edge_of(mesh::next(s.half_edges, h)));
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  Execution silent;
  s.sheets = uv::corner_sheets(s.surface, s.half_edges, edges, s.classes, silent, names);
  s.seams = std::move(edges);
}

py::array edge_values(const PuncturedStructure& s) {
  Eigen::MatrixXcd values;
  {
    const py::gil_scoped_release unlocked;
    values = pipeline::edge_values(s);
  }
  return copy(values);
}

py::array sphere_map(const PuncturedStructure& s) {
  pipeline::PointArray points;
  {
    const py::gil_scoped_release unlocked;
    points = pipeline::sphere_map(s);
  }
  return give_matrix(std::move(points));
}

}  // namespace

void bind_punctured_structure(py::module_& m) {
  py::class_<PuncturedStructure, std::shared_ptr<PuncturedStructure>>(m, "PuncturedStructure")
      .def("uv", &uv)
      .def("cut_along", &cut_along)
      .def("edge_values", &edge_values)
      .def("sphere_map", &sphere_map)
      .def("disk_map", [](const PuncturedStructure& s) { return copy(pipeline::disk_map(s)); })
      .def("form_count", [](const PuncturedStructure& s) { return 1 + s.periods.cols(); })
      .def("surface", [](const PuncturedStructure& s) { return std::make_shared<mesh::Surface>(s.surface); })
      .def("punctures", [](const PuncturedStructure& s) { return copy(s.punctures.vertices); })
      .def("residues", [](const PuncturedStructure& s) { return copy(s.punctures.residues); })
      .def("seams", [](const PuncturedStructure& s) { return copy(s.seams); })
      .def("residuals",
           [](const PuncturedStructure& s) {
             return py::make_tuple(s.residuals.closedness, s.residuals.harmonicity, s.period_residual);
           })
      .def("solver",
           [](const PuncturedStructure& s) {
             return py::make_tuple(s.solver.name, s.solver.reason, s.solver.iterations, s.solver.residual);
           })
      .def("intrinsic", [](const PuncturedStructure& s) { return py::make_tuple(0, s.mollification); })
      .def("timings", [](const PuncturedStructure& s) { return s.seconds; });
  m.def("punctured_structure", &compute);
}

}  // namespace holomorph::bindings
