#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <memory>

#include "bindings/arrays.h"
#include "bindings/bindings.h"
#include "bindings/callback.h"
#include "mesh/intrinsic_surface.h"
#include "structure/nested_level.h"

namespace holomorph::bindings {
namespace {

using structure::SideClasses;

// A surface of triangles and lengths that stands for another one, with its errors.
std::shared_ptr<mesh::Surface> refined_surface(int vertex_count, const Contiguous<std::int64_t>& faces,
                                               const Contiguous<double>& lengths,
                                               const Contiguous<std::int64_t>& face_edges,
                                               const Contiguous<double>& errors) {
  const auto f = rows<std::int64_t, 3>(faces), names = rows<std::int64_t, 3>(face_edges);
  const auto l = rows<double, 3>(lengths);
  const auto e = values(errors);
  const py::gil_scoped_release unlocked;
  Execution execution;
  auto surface = std::make_shared<mesh::Surface>(mesh::make_intrinsic_surface(vertex_count, f, l, names, execution));
  surface->metric_errors.assign(e.begin(), e.end());
  return surface;
}

structure::NestedLevel solve_level(const mesh::Surface& surface, const Contiguous<int>& classes, int natural,
                                   const std::string& solver, int threads, std::int64_t memory_limit,
                                   const py::object& progress) {
  Execution execution(threads, callback(progress));
  const Eigen::Map<const SideClasses> given(classes.data(), classes.shape(0), classes.shape(1));
  const py::gil_scoped_release unlocked;
  return structure::solve_level(surface, given, natural, {solver, memory_limit}, execution);
}

// Energies of forms with these functions, on the Delaunay triangulation of the surface.
structure::CertainGram measure(const mesh::Surface& surface, const Contiguous<int>& classes, int natural,
                               const forms::RowMajorMatrix& functions) {
  const Eigen::Map<const SideClasses> given(classes.data(), classes.shape(0), classes.shape(1));
  Execution execution;
  return structure::measure(surface, given, natural, functions, execution);
}

}  // namespace

void bind_nested_level(py::module_& m) {
  using structure::CertainGram;
  using structure::NestedLevel;
  py::class_<CertainGram>(m, "CertainGram")
      .def_readonly("gram", &CertainGram::gram)
      .def_readonly("certain", &CertainGram::certain);
  const auto viewed = [](auto member) {
    return [member](py::object self) { return view(self.cast<const NestedLevel&>().*member, self); };
  };
  py::class_<NestedLevel>(m, "NestedLevel")
      .def_property_readonly("triangles", viewed(&NestedLevel::triangles))
      .def_property_readonly("triangle_edges", viewed(&NestedLevel::triangle_edges))
      .def_property_readonly("lengths", viewed(&NestedLevel::lengths))
      .def_property_readonly("errors", viewed(&NestedLevel::errors))
      .def_property_readonly("classes", [](const NestedLevel& level) { return copy(level.classes); })
      .def_property_readonly("functions", [](const NestedLevel& level) { return copy(level.functions); })
      .def_readonly("energies", &NestedLevel::energies)
      .def_readonly("mollification", &NestedLevel::mollification);
  m.def("refined_surface", &refined_surface, py::arg("vertex_count"), py::arg("faces"), py::arg("lengths"),
        py::arg("face_edges"), py::arg("errors"));
  m.def("solve_level", &solve_level, py::arg("surface"), py::arg("classes"), py::arg("natural"), py::arg("solver"),
        py::arg("threads"), py::arg("memory_limit"), py::arg("progress"));
  m.def("measure", &measure, py::arg("surface"), py::arg("classes"), py::arg("natural"), py::arg("functions"));
}

}  // namespace holomorph::bindings
