// Methods that the results for all kinds of surfaces have in Python.
#pragma once

#include "bindings/structures.h"
#include "uv/uv_map.h"

namespace holomorph::bindings {

template <class Value>
py::tuple uv_solver(Structure<Value>& s) {
  pipeline::SolverReport solver;
  s.with_forms([&](auto& forms, Execution& execution) {
    forms.prepare(execution);
    solver = forms.solver();
  });
  return report(solver);
}

template <class Value>
void prepare_uv(Structure<Value>& s, const py::object& progress_function) {
  s.with_forms([](auto& forms, Execution& execution) { forms.prepare(execution); }, callback(progress_function));
}

inline py::list loops_of_vertices(const mesh::EdgeEnds& ends,
                                  const std::vector<std::vector<mesh::HalfedgeHandle>>& loops) {
  py::list result;
  for (const auto& loop : loops) {
    std::vector<int> vertices;
    for (const auto h : loop) vertices.push_back(mesh::from_vertex(ends, h));
    result.append(copy(vertices));
  }
  return result;
}

/// @throws SolverError where `what` takes more than the structure's limit of memory
template <class Value>
void require_memory(const Structure<Value>& s, const std::string& what, std::int64_t bytes) {
  pipeline::require_memory(what, bytes, s.options.memory_limit);
}

/// #forms x #E
template <class Value>
py::array harmonic_forms(Structure<Value>& s) {
  const auto count = static_cast<py::ssize_t>(s.value.harmonic.classes.form_count),
             edges = static_cast<py::ssize_t>(s.surface->edges.size());
  require_memory(s, "the " + std::to_string(count) + " harmonic forms on " + std::to_string(edges) + " edges",
                 8 * count * edges);
  py::array_t<double> values({count, edges});
  double* data = values.mutable_data();
  s.with_forms([&](auto& forms, Execution& execution) { forms.edge_values(data, execution); });
  return read_only(std::move(values));
}

template <class Value>
py::array uv(Structure<Value>& s, const Eigen::VectorXcd& coefficients) {
  // NumPy takes large arrays on large pages.
  py::array_t<double> result({static_cast<py::ssize_t>(s.surface->polygons.corner_vertices.size()), py::ssize_t{2}});
  Eigen::Map<uv::UvArray> corners(result.mutable_data(), result.shape(0), 2);
  s.with_forms([&](auto& forms, Execution& execution) {
    uv::write_uv_map(*s.surface, s.value.sheets, forms.function(coefficients, execution), coefficients, corners,
                     execution.workers());
  });
  return read_only(std::move(result));
}

template <class Value>
Eigen::VectorXcd balanced_coefficients(Structure<Value>& s, const Eigen::MatrixXcd& basis,
                                       const Eigen::MatrixXd& area_form, uv::Coefficients kind) {
  Eigen::VectorXcd c;
  s.with_forms([&](auto& forms, Execution& execution) {
    const auto samples = basis.cols() > 1 ? forms.samples(execution) : uv::FormSamples();
    c = uv::balanced_coefficients(*s.surface, samples, basis, area_form, kind, execution.workers());
  });
  return c;
}

/// Takes the sheets of the caller's cut instead of our own.
template <class Value>
void cut_along(Structure<Value>& s, const std::vector<int>& edges, const std::vector<int>& names) {
  const py::gil_scoped_release unlocked;
  Execution silent;
  s.value.sheets = uv::corner_sheets(*s.surface, mesh::half_edges(*s.surface, silent), edges, s.value.harmonic.classes,
                                     silent, names);
  s.value.seams = edges;
}

/// Everything that needs no more than the members named above.
template <class Value>
py::class_<Structure<Value>, std::shared_ptr<Structure<Value>>> bind_structure(py::module_& m, const char* name) {
  using S = Structure<Value>;
  return py::class_<S, std::shared_ptr<S>>(m, name)
      .def("prepare_uv", &prepare_uv<Value>)
      .def("require_memory", &require_memory<Value>)
      .def("harmonic_forms", &harmonic_forms<Value>)
      .def("uv", &uv<Value>)
      .def("uv_solver", &uv_solver<Value>)
      .def("cut_along", &cut_along<Value>)
      .def("seams", [](const S& s) { return copy(s.value.seams); })
      .def("solver", [](const S& s) { return report(s.value.solver); })
      .def("intrinsic", [](const S& s) { return py::make_tuple(s.value.flip_count, s.value.mollification); })
      .def("timings", [](const S& s) { return s.value.seconds; });
}

}  // namespace holomorph::bindings
