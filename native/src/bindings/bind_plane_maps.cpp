#include <pybind11/complex.h>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <memory>

#include "bindings/arrays.h"
#include "bindings/bindings.h"
#include "bindings/callback.h"
#include "bindings/records.h"
#include "plane/clear_corners.h"
#include "plane/free_boundary.h"
#include "plane/rectangle.h"
#include "plane/rectangle_corners.h"
#include "plane/triangle_map.h"

namespace holomorph::bindings {
namespace {

using plane::PlaneMap;

std::shared_ptr<PlaneMap> rectangle(const mesh::Surface& surface, const std::vector<int>& corners,
                                    const std::vector<int>& labels, const std::string& solver, int threads,
                                    const py::object& progress_function) {
  Execution execution(threads, callback(progress_function));
  const py::gil_scoped_release unlocked;
  return std::make_shared<PlaneMap>(plane::rectangle_map(surface, corners, labels, {solver}, execution));
}

// One without a choice.
auto plane_map(PlaneMap (*function)(const mesh::Surface&, const plane::Options&, Execution&)) {
  return [function](const mesh::Surface& surface, const std::string& solver, int threads,
                    const py::object& progress_function) {
    Execution execution(threads, callback(progress_function));
    const py::gil_scoped_release unlocked;
    return std::make_shared<PlaneMap>(function(surface, {solver}, execution));
  };
}

// One that needs the surface alone.
template <class Result>
auto of_surface(Result (*function)(const mesh::Surface&, Execution&)) {
  return [function](const mesh::Surface& surface) {
    const py::gil_scoped_release unlocked;
    Execution execution;
    return function(surface, execution);
  };
}

}  // namespace

void bind_plane_maps(py::module_& m) {
  py::class_<PlaneMap, std::shared_ptr<PlaneMap>>(m, "PlaneMap")
      .def("points", [](const PlaneMap& map) { return copy(map.points); })
      .def("corners", [](const PlaneMap& map) { return copy(map.corners); })
      .def_readonly("modulus", &PlaneMap::modulus)
      .def_readonly("lower", &PlaneMap::lower)
      .def_readonly("upper", &PlaneMap::upper)
      .def("scale_factors", [](const PlaneMap& map) { return copy(map.scale_factors); })
      .def("collapsed_triangles", [](const PlaneMap& map) { return copy(map.collapsed_triangles); })
      .def("residuals", [](const PlaneMap& map) { return Residuals{.harmonicity = map.harmonicity}; })
      .def("solver", [](const PlaneMap& map) { return map.solver; })
      .def("flip_count", [](const PlaneMap& map) { return map.flip_count; })
      .def("mollification", [](const PlaneMap& map) { return map.mollification; })
      .def("metric_error", [](const PlaneMap& map) { return map.metric; })
      .def("timings", [](const PlaneMap& map) { return map.seconds; });
  m.def("rectangle_map", &rectangle, py::arg("surface"), py::arg("corners"), py::arg("labels"), py::arg("solver"),
        py::arg("threads"), py::arg("progress"));
  m.def("triangle_map", plane_map(&plane::triangle_map), py::arg("surface"), py::arg("solver"), py::arg("threads"),
        py::arg("progress"));
  m.def("free_boundary_map", plane_map(&plane::free_boundary_map), py::arg("surface"), py::arg("solver"),
        py::arg("threads"), py::arg("progress"));
  m.def("boundary_length", of_surface(&plane::boundary_length));
  m.def("quarter_corners", of_surface(&plane::quarter_corners));
  m.def("clear_corners", of_surface(&plane::clear_corners));
}

}  // namespace holomorph::bindings
