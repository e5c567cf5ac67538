#include <pybind11/complex.h>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <memory>

#include "bindings/arrays.h"
#include "bindings/bindings.h"
#include "bindings/callback.h"
#include "bindings/solver_report.h"
#include "plane/clear_corners.h"
#include "plane/free_boundary.h"
#include "plane/rectangle.h"
#include "plane/rectangle_corners.h"
#include "plane/triangle_map.h"

namespace holomorph::bindings {
namespace {

using plane::PlaneMap;

std::shared_ptr<PlaneMap> rectangle(const mesh::Surface& surface, const std::vector<int>& corners,
                                    const std::vector<int>& names, const std::string& solver, int threads,
                                    const py::object& progress_function) {
  Execution execution(threads, callback(progress_function));
  const py::gil_scoped_release unlocked;
  return std::make_shared<PlaneMap>(plane::rectangle_map(surface, corners, names, {solver}, execution));
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
      .def("modulus", [](const PlaneMap& map) { return py::make_tuple(map.modulus, map.lower, map.upper); })
      .def("scale_factors", [](const PlaneMap& map) { return copy(map.scale_factors); })
      .def("collapsed_triangles", [](const PlaneMap& map) { return copy(map.collapsed_triangles); })
      .def("certificate", [](const PlaneMap& map) { return py::make_tuple(0.0, map.harmonicity, 0.0, 0.0, 0.0); })
      .def("solver", [](const PlaneMap& map) { return report(map.solver); })
      .def("intrinsic",
           [](const PlaneMap& map) { return py::make_tuple(map.flip_count, map.mollification, map.metric); })
      .def("timings", [](const PlaneMap& map) { return map.seconds; });
  m.def("rectangle_map", &rectangle);
  m.def("triangle_map", plane_map(&plane::triangle_map));
  m.def("free_boundary_map", plane_map(&plane::free_boundary_map));
  m.def("boundary_length", of_surface(&plane::boundary_length));
  m.def("quarter_corners", of_surface(&plane::quarter_corners));
  m.def("clear_corners", of_surface(&plane::clear_corners));
}

}  // namespace holomorph::bindings
