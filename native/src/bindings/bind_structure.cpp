#include <pybind11/complex.h>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <memory>
#include <optional>

#include "bindings/arrays.h"
#include "bindings/bindings.h"
#include "bindings/callback.h"
#include "bindings/records.h"
#include "bindings/structure_with_forms.h"
#include "multiresolution/paper_structure.h"
#include "plane/disk_map.h"
#include "plane/sphere_map.h"
#include "structure/balanced_map.h"
#include "structure/conformal_structure.h"
#include "structure/pole_structure.h"
#include "structure/uv_forms.h"

namespace holomorph::bindings {
namespace {

using structure::Options;
using SurfacePointer = std::shared_ptr<mesh::Surface>;
using Pointer = StructurePointer;

// Runs `compute(options, execution)` without the interpreter's lock.
template <class Compute>
Pointer make(const Options& options, int threads, const py::object& progress_function, Compute compute) {
  Execution execution(threads, callback(progress_function));
  const py::gil_scoped_release unlocked;
  auto made = std::make_shared<Structure>();
  made->options = options;
  made->threads = threads;
  made->value = compute(options, execution);
  made->forms = structure::uv_forms(made->value, made->options);
  return made;
}

Pointer conformal(const SurfacePointer& surface, bool over_double, const std::string& solver, int threads,
                  std::int64_t memory_limit, const py::object& progress) {
  const auto boundary = over_double ? structure::Boundary::double_cover : structure::Boundary::natural;
  return make({solver, memory_limit, boundary}, threads, progress, [&](const Options& options, Execution& execution) {
    return structure::conformal_structure(surface, options, execution);
  });
}

Pointer with_poles(const SurfacePointer& surface, const std::vector<int>& vertices,
                   const std::vector<std::complex<double>>& residues, const std::vector<int>& labels,
                   const std::string& solver, int threads, std::int64_t memory_limit, const py::object& progress) {
  return make({solver, memory_limit}, threads, progress, [&](const Options& options, Execution& execution) {
    return structure::pole_structure(surface, {vertices, residues, labels}, options, execution);
  });
}

using Thresholds = std::optional<std::vector<std::int64_t>>;

Pointer paper(const SurfacePointer& surface, const Thresholds& thresholds, int threads, std::int64_t memory_limit,
              const py::object& progress) {
  return make({"auto", memory_limit}, threads, progress, [&](const Options& options, Execution& execution) {
    return multiresolution::paper_structure(surface, options, execution, {thresholds});
  });
}

// The structure of a level of a progressive mesh, in the classes of its base; `surface` is the surface of that level.
Pointer conformal_of_level(const progressive::ProgressiveMesh& mesh, int splits, const SurfacePointer& surface,
                           const std::string& solver, int threads, std::int64_t memory_limit,
                           const py::object& progress) {
  return make({solver, memory_limit}, threads, progress, [&](const Options& options, Execution& execution) {
    return structure::conformal_structure(surface, options, execution, topology::lifted_bases(mesh, splits, *surface));
  });
}

Pointer paper_of_level(const progressive::ProgressiveMesh& mesh, int splits, const SurfacePointer& surface,
                       const Thresholds& thresholds, int threads, std::int64_t memory_limit,
                       const py::object& progress) {
  return make({"auto", memory_limit}, threads, progress, [&](const Options& options, Execution& execution) {
    return multiresolution::paper_structure(surface, options, execution, {thresholds},
                                            multiresolution::paper_levels(mesh, splits, *surface));
  });
}

void prepare_uv(Structure& s, const py::object& progress) {
  s.with_forms([](auto& forms, Execution& execution) { forms.prepare(execution); }, callback(progress));
}

structure::SolverReport uv_solver(Structure& s) {
  structure::SolverReport found;
  s.with_forms([&](auto& forms, Execution& execution) {
    forms.prepare(execution);
    found = forms.solver();
  });
  return found;
}

// UVs of sum_k p_k h_k, #C x 2.
py::array uv(Structure& s, const Eigen::VectorXcd& p) {
  // NumPy takes large arrays on large pages.
  py::array_t<double> result(
      {static_cast<py::ssize_t>(s.value.surface->polygons.corner_vertices.size()), py::ssize_t{2}});
  Eigen::Map<uv::UvArray> corners(result.mutable_data(), result.shape(0), 2);
  s.with_forms([&](auto& forms, Execution& execution) {
    structure::write_uv_map(s.value, forms.function(p, execution), p, corners, execution.workers());
  });
  return read_only(std::move(result));
}

// Values of all forms of the basis on the edges, #forms x #E.
py::array basis_forms(Structure& s) {
  py::array_t<double> values({static_cast<py::ssize_t>(s.value.topology.families.count()),
                              static_cast<py::ssize_t>(s.value.surface->edges.size())});
  Eigen::Map<forms::RowMajorMatrix> rows(values.mutable_data(), values.shape(0), values.shape(1));
  s.with_forms([&](auto& forms, Execution& execution) { forms.write_edge_values(rows, execution); });
  return read_only(std::move(values));
}

Eigen::VectorXcd balanced_coefficients(Structure& s) {
  Eigen::VectorXcd c;
  s.with_forms(
      [&](auto& forms, Execution& execution) { c = structure::balanced_coefficients(s.value, forms, execution); });
  return c;
}

py::array disk_map(Structure& s) {
  Eigen::VectorXcd z;
  s.with_forms([&](auto& forms, Execution& execution) {
    z = plane::disk_map(s.value, forms.function(s.value.differentials.col(0), execution), execution.workers());
  });
  return copy(z);
}

py::array sphere_map(Structure& s) {
  plane::PointArray points;
  s.with_forms([&](auto& forms, Execution& execution) {
    plane::require_sphere(s.value);
    points = plane::sphere_map(s.value, forms.function(s.value.differentials.col(0), execution), execution.workers());
  });
  return give_matrix(std::move(points));
}

// The same structure cut elsewhere; the forms are shared.
Pointer cut_along(const Pointer& s, const std::vector<int>& edges, const std::vector<int>& labels) {
  auto made = std::make_shared<Structure>();
  made->options = s->options;
  made->threads = s->threads;
  made->uncut = s->uncut ? s->uncut : s;
  s->with_forms(
      [&](auto&, Execution& execution) { made->value = structure::cut_along(s->value, edges, labels, execution); });
  return made;
}

void bind_actions(py::class_<Structure, Pointer>& type) {
  type.def("prepare_uv", &prepare_uv)
      .def("uv_solver", &uv_solver)
      .def("uv", &uv)
      .def("basis_forms", &basis_forms)
      .def("balanced_coefficients", &balanced_coefficients)
      .def("disk_map", &disk_map)
      .def("sphere_map", &sphere_map)
      .def("cut_along", &cut_along, py::arg("edges"), py::arg("labels"))
      .def("require_memory", [](const Structure& s, const std::string& what, std::int64_t bytes) {
        structure::require_memory(what, bytes, s.options.memory_limit);
      });
}

void bind_values(py::class_<Structure, Pointer>& type) {
  type.def("surface", [](const Structure& s) { return std::const_pointer_cast<mesh::Surface>(s.value.surface); })
      .def("families", [](const Structure& s) { return s.value.topology.families; })
      .def("differentials", [](const Structure& s) { return copy(s.value.differentials); })
      .def("poles",
           [](const Structure& s) { return copy(s.value.poles ? s.value.poles->chosen.vertices : std::vector<int>()); })
      .def("residues",
           [](const Structure& s) {
             return copy(s.value.poles ? s.value.poles->chosen.residues : std::vector<std::complex<double>>());
           })
      .def("spokes", [](const Structure& s) { return copy(structure::spokes(s.value)); })
      .def("collapsed_triangles",
           [](const Structure& s) {
             return copy(mesh::triangles_on_one_loop(*s.value.surface, s.value.topology.boundary));
           })
      .def("memory", [](const Structure& s) { return s.value.record.memory; })
      .def("solver", [](const Structure& s) { return s.value.record.solver; })
      .def("timings", [](const Structure& s) { return s.value.record.seconds; })
      .def_readonly("threads", &Structure::threads);
}

}  // namespace

void bind_structure(py::module_& m) {
  using structure::Families;
  py::class_<Families>(m, "Families")
      .def_readonly("natural", &Families::natural)
      .def_readonly("dirichlet", &Families::dirichlet)
      .def_readonly("poles", &Families::poles)
      .def_property_readonly("count", &Families::count);
  py::class_<Structure, Pointer> type(m, "Structure");
  bind_actions(type);
  bind_values(type);
  bind_topology(type);
  bind_invariants(type);
  m.def("conformal_structure", &conformal, py::arg("surface"), py::arg("over_double"), py::arg("solver"),
        py::arg("threads"), py::arg("memory_limit"), py::arg("progress"));
  m.def("pole_structure", &with_poles, py::arg("surface"), py::arg("poles"), py::arg("residues"), py::arg("labels"),
        py::arg("solver"), py::arg("threads"), py::arg("memory_limit"), py::arg("progress"));
  m.def("paper_structure", &paper, py::arg("surface"), py::arg("thresholds"), py::arg("threads"),
        py::arg("memory_limit"), py::arg("progress"));
  m.def("conformal_structure_of_level", &conformal_of_level, py::arg("mesh"), py::arg("splits"), py::arg("surface"),
        py::arg("solver"), py::arg("threads"), py::arg("memory_limit"), py::arg("progress"));
  m.def("paper_structure_of_level", &paper_of_level, py::arg("mesh"), py::arg("splits"), py::arg("surface"),
        py::arg("thresholds"), py::arg("threads"), py::arg("memory_limit"), py::arg("progress"));
}

}  // namespace holomorph::bindings
