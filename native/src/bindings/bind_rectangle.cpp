#include <pybind11/complex.h>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <memory>

#include "bindings/arrays.h"
#include "bindings/bindings.h"
#include "bindings/callback.h"
#include "pipeline/rectangle.h"
#include "pipeline/triangle_map.h"

namespace holomorph::bindings {
namespace {

using pipeline::RectangleMap;
using pipeline::TriangleMap;

std::shared_ptr<RectangleMap> compute(const mesh::Surface& surface, const std::vector<int>& corners,
                                      const std::vector<int>& names, const std::string& solver, int threads,
                                      const py::object& progress_function) {
  Execution execution(threads, callback(progress_function));
  const py::gil_scoped_release unlocked;
  return std::make_shared<RectangleMap>(pipeline::rectangle_map(surface, corners, names, {solver, threads}, execution));
}

std::shared_ptr<TriangleMap> triangle(const mesh::Surface& surface, const std::string& solver, int threads,
                                      const py::object& progress_function) {
  Execution execution(threads, callback(progress_function));
  const py::gil_scoped_release unlocked;
  return std::make_shared<TriangleMap>(pipeline::triangle_map(surface, {solver, threads}, execution));
}

py::tuple report(const pipeline::SolverReport& solver) {
  return py::make_tuple(solver.name, solver.reason, solver.iterations, solver.residual);
}

// Of a form on the edges of any surface.
py::array averaged_star(const mesh::Surface& surface, const Contiguous<double>& form) {
  Execution silent;
  return copy(forms::averaged_star(mesh::half_edges(surface, silent), surface.edge_lengths, values(form)));
}

}  // namespace

void bind_rectangle(py::module_& m) {
  py::class_<RectangleMap, std::shared_ptr<RectangleMap>>(m, "RectangleMap")
      .def("corners", [](const RectangleMap& r) { return copy(std::vector<int>(r.corners.begin(), r.corners.end())); })
      .def("u", [](const RectangleMap& r) { return copy(r.u); })
      .def("v", [](const RectangleMap& r) { return copy(r.v); })
      .def("modulus", [](const RectangleMap& r) { return py::make_tuple(r.modulus, r.lower, r.upper); })
      .def("collapsed_triangles", [](const RectangleMap& r) { return copy(r.collapsed_triangles); })
      .def("residuals", [](const RectangleMap& r) { return py::make_tuple(0.0, r.harmonicity, 0.0); })
      .def("solver", [](const RectangleMap& r) { return report(r.solver); })
      .def("intrinsic", [](const RectangleMap& r) { return py::make_tuple(r.flip_count, r.mollification); })
      .def("timings", [](const RectangleMap& r) { return r.seconds; });
  py::class_<TriangleMap, std::shared_ptr<TriangleMap>>(m, "TriangleMap")
      .def("points", [](const TriangleMap& t) { return copy(t.points); })
      .def("residuals", [](const TriangleMap& t) { return py::make_tuple(0.0, t.harmonicity, 0.0); })
      .def("solver", [](const TriangleMap& t) { return report(t.solver); })
      .def("intrinsic", [](const TriangleMap& t) { return py::make_tuple(0, t.mollification); })
      .def("timings", [](const TriangleMap& t) { return t.seconds; });
  m.def("rectangle_map", &compute);
  m.def("triangle_map", &triangle);
  m.def("averaged_star", &averaged_star);
  m.def("boundary_length", &pipeline::boundary_length, py::call_guard<py::gil_scoped_release>());
  m.def("quarter_corners", &pipeline::quarter_corners, py::call_guard<py::gil_scoped_release>());
  m.def("clear_corners", &pipeline::clear_corners, py::call_guard<py::gil_scoped_release>());
}

}  // namespace holomorph::bindings
