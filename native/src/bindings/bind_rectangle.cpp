#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <memory>

#include "bindings/arrays.h"
#include "bindings/bindings.h"
#include "bindings/callback.h"
#include "pipeline/rectangle.h"

namespace holomorph::bindings {
namespace {

using pipeline::RectangleMap;

std::shared_ptr<RectangleMap> compute(const mesh::Surface& surface, const std::vector<int>& corners,
                                      const std::vector<int>& names, const std::string& solver, int threads,
                                      const py::object& progress_function) {
  Progress progress(callback(progress_function));
  const py::gil_scoped_release unlocked;
  return std::make_shared<RectangleMap>(pipeline::rectangle_map(surface, corners, names, {solver, threads}, progress));
}

// Of a form on the edges of any surface.
py::array averaged_star(const mesh::Surface& surface, const Contiguous<double>& form) {
  Progress silent;
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
      .def("solver",
           [](const RectangleMap& r) {
             return py::make_tuple(r.solver.name, r.solver.reason, r.solver.iterations, r.solver.residual);
           })
      .def("intrinsic", [](const RectangleMap& r) { return py::make_tuple(r.flip_count, r.mollification); })
      .def("timings", [](const RectangleMap& r) { return r.seconds; });
  m.def("rectangle_map", &compute);
  m.def("averaged_star", &averaged_star);
  m.def("quarter_corners", &pipeline::quarter_corners, py::call_guard<py::gil_scoped_release>());
  m.def("clear_corners", &pipeline::clear_corners, py::call_guard<py::gil_scoped_release>());
}

}  // namespace holomorph::bindings
