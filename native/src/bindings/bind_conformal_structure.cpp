#include <pybind11/complex.h>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <memory>
#include <mutex>
#include <optional>

#include "bindings/arrays.h"
#include "bindings/bindings.h"
#include "bindings/callback.h"
#include "pipeline/artist_forms.h"
#include "pipeline/harmonic_map.h"
#include "uv/uv_map.h"

namespace holomorph::bindings {
namespace {

using mesh::Surface;
using pipeline::ConformalStructure;

// The C++ structure together with the surface that it belongs to, and the forms for UVs once they were asked for.
struct Structure {
  std::shared_ptr<const Surface> surface;
  ConformalStructure value;
  pipeline::Options options;
  std::mutex mutex;
  std::optional<pipeline::HarmonicForms> artist_forms;

  // Called without the interpreter's lock.
  const forms::ClosedForms& forms_for_uv(Progress& progress) {
    const std::lock_guard<std::mutex> one_at_a_time(mutex);
    if (!artist_forms) artist_forms = pipeline::artist_forms(*surface, value, options, progress);
    return artist_forms->forms;
  }
  const forms::ClosedForms& forms_for_uv() {
    Progress silent;
    return forms_for_uv(silent);
  }
};

std::shared_ptr<Structure> compute(std::shared_ptr<Surface> surface, const std::string& solver, int threads,
                                   const py::object& progress_function) {
  Progress progress(callback(progress_function));
  const py::gil_scoped_release unlocked;
  auto structure = std::make_shared<Structure>();
  structure->options = {solver, threads};
  structure->value = pipeline::conformal_structure(*surface, structure->options, progress);
  structure->surface = std::move(surface);
  return structure;
}

py::tuple report(const pipeline::SolverReport& solver) {
  return py::make_tuple(solver.name, solver.reason, solver.iterations, solver.residual);
}

py::tuple uv_solver(Structure& s) {
  {
    const py::gil_scoped_release unlocked;
    s.forms_for_uv();
  }
  return report(s.artist_forms->solver);
}

// Of a level of a progressive mesh, in the classes of its base; `surface` is the surface of that level.
std::shared_ptr<Structure> compute_level(const progressive::ProgressiveMesh& mesh, int splits,
                                         std::shared_ptr<Surface> surface, const std::string& solver, int threads,
                                         const py::object& progress_function) {
  Progress progress(callback(progress_function));
  const py::gil_scoped_release unlocked;
  auto structure = std::make_shared<Structure>();
  structure->options = {solver, threads};
  structure->value = pipeline::conformal_structure(*surface, structure->options, progress,
                                                   topology::carried_bases(mesh, splits, *surface));
  structure->surface = std::move(surface);
  return structure;
}

void prepare_uv(Structure& s, const py::object& progress_function) {
  Progress progress(callback(progress_function));
  const py::gil_scoped_release unlocked;
  s.forms_for_uv(progress);
}

py::list homology_basis(const Structure& s) {
  py::list loops;
  for (const auto& loop : s.value.homology_basis) {
    std::vector<int> vertices;
    for (const auto h : loop) vertices.push_back(mesh::from_vertex(s.value.half_edges, h));
    loops.append(copy(vertices));
  }
  return loops;
}

py::array harmonic_forms(Structure& s) {
  const int edges = static_cast<int>(s.surface->edges.size());
  forms::RowMajorMatrix values;
  {
    const py::gil_scoped_release unlocked;
    values = forms::edge_values(s.value.half_edges, s.forms_for_uv(), 0, edges).transpose();
  }
  const py::ssize_t rows = values.rows(), columns = values.cols();
  return give(std::move(values), {rows, columns});
}

py::array uv(Structure& s, const Eigen::VectorXcd& periods) {
  uv::UvArray result;
  {
    const py::gil_scoped_release unlocked;
    result = uv::uv_map(*s.surface, s.value.sheets, s.forms_for_uv().functions, periods);
  }
  const py::ssize_t corners = result.rows();
  return give(std::move(result), {corners, 2});
}

py::array balanced_coefficients(Structure& s) {
  Eigen::VectorXcd c;
  {
    const py::gil_scoped_release unlocked;
    c = uv::balanced_coefficients(*s.surface, s.value.half_edges, s.forms_for_uv(), s.value.holomorphic.periods,
                                  s.value.holomorphic.period_matrix.imag());
  }
  return read_only(copy(c).attr("reshape")(c.size()));
}

// Moves of the vertices, and the solver's report.
py::tuple harmonic_map(const Surface& surface, const Contiguous<double>& corner_values, const std::string& solver,
                       int threads, const py::object& progress_function) {
  using Rows = forms::RowMajorMatrix;
  const Rows given = Eigen::Map<const Rows>(corner_values.data(), corner_values.shape(0), corner_values.shape(1));
  Progress progress(callback(progress_function));
  pipeline::HarmonicMap map;
  {
    const py::gil_scoped_release unlocked;
    map = pipeline::harmonic_map(surface, given, {solver, threads}, progress);
  }
  return py::make_tuple(copy(map.moves), report(map.solver));
}

py::array averaged_star(const Structure& s, const Contiguous<double>& form) {
  return copy(forms::averaged_star(s.value.half_edges, s.surface->edge_lengths, values(form)));
}

py::tuple quality(const Surface& surface, const Contiguous<double>& uv_array) {
  const uv::UvArray uv = Eigen::Map<const uv::UvArray>(uv_array.data(), uv_array.shape(0), 2);
  uv::Quality q;
  {
    const py::gil_scoped_release unlocked;
    q = uv::quality(surface, uv);
  }
  const py::array flipped = give(std::move(q.flipped)).attr("view")("bool");
  return py::make_tuple(give(std::move(q.angle)), give(std::move(q.area)), flipped, q.mean_angle, q.density_ratio);
}

}  // namespace

void bind_conformal_structure(py::module_& m) {
  py::class_<Structure, std::shared_ptr<Structure>>(m, "ConformalStructure")
      .def("prepare_uv", &prepare_uv)
      .def("homology_basis", &homology_basis)
      .def("harmonic_forms", &harmonic_forms)
      .def("uv", &uv)
      .def("balanced_coefficients", &balanced_coefficients)
      .def("averaged_star", &averaged_star)
      .def("intersection_matrix", [](const Structure& s) { return copy(s.value.canonical.intersection); })
      .def("canonical_basis", [](const Structure& s) { return copy(s.value.canonical.cycles); })
      .def("gram_matrix", [](const Structure& s) { return copy(s.value.gram_matrix); })
      .def("period_matrix", [](const Structure& s) { return copy(s.value.holomorphic.period_matrix); })
      .def("period_bounds",
           [](const Structure& s) {
             return py::make_tuple(copy(s.value.holomorphic.lower), copy(s.value.holomorphic.upper));
           })
      .def("periods", [](const Structure& s) { return copy(s.value.holomorphic.periods); })
      .def("seams", [](const Structure& s) { return copy(s.value.seams); })
      .def("residuals",
           [](const Structure& s) {
             return py::make_tuple(s.value.residuals.closedness, s.value.residuals.harmonicity,
                                   s.value.period_residual);
           })
      .def("solver", [](const Structure& s) { return report(s.value.solver); })
      .def("uv_solver", &uv_solver)
      .def("intrinsic", [](const Structure& s) { return py::make_tuple(s.value.flip_count, s.value.mollification); })
      .def("timings", [](const Structure& s) { return s.value.seconds; });
  m.def("conformal_structure", &compute);
  m.def("conformal_structure_of_level", &compute_level);
  m.def("quality", &quality);
  m.def("harmonic_map", &harmonic_map);
}

}  // namespace holomorph::bindings
