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

// triangles, triangle_edges, lengths, errors, classes, functions, gram, certain_gram, mollification
py::tuple solve_level(const mesh::Surface& surface, const Contiguous<int>& classes, int natural,
                      const std::string& solver, int threads, std::int64_t memory_limit, const py::object& progress) {
  structure::NestedLevel level;
  {
    Execution execution(threads, callback(progress));
    const Eigen::Map<const SideClasses> given(classes.data(), classes.shape(0), classes.shape(1));
    const py::gil_scoped_release unlocked;
    level = structure::solve_level(surface, given, natural, {solver, memory_limit}, execution);
  }
  const auto faces = static_cast<py::ssize_t>(level.triangles.size());
  const auto triples = [faces](const std::vector<mesh::Triple>& list) {
    return read_only(py::array_t<int>({faces, py::ssize_t{3}}, list.front().data()));
  };
  return py::make_tuple(triples(level.triangles), triples(level.triangle_edges), copy(level.lengths),
                        copy(level.errors), copy(level.classes), copy(level.functions), level.energies.gram,
                        level.energies.certain, level.mollification);
}

// (gram, certain gram matrices) of forms with these functions, on the Delaunay triangulation of the surface.
py::tuple measure(const mesh::Surface& surface, const Contiguous<int>& classes, int natural,
                  const forms::RowMajorMatrix& functions) {
  const Eigen::Map<const SideClasses> given(classes.data(), classes.shape(0), classes.shape(1));
  Execution execution;
  const auto energies = structure::measure(surface, given, natural, functions, execution);
  return py::make_tuple(energies.gram, energies.certain);
}

}  // namespace

void bind_nested_level(py::module_& m) {
  m.def("refined_surface", &refined_surface);
  m.def("solve_level", &solve_level);
  m.def("measure", &measure);
}

}  // namespace holomorph::bindings
