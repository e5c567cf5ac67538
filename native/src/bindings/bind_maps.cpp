// Maps into the plane (UVs, maps of disks), and records of solves.
#include <pybind11/complex.h>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <memory>

#include "bindings/arrays.h"
#include "bindings/bindings.h"
#include "bindings/records.h"
#include "flat/dirichlet_problem.h"
#include "flat/rectangle.h"
#include "forms/gram_matrices.h"
#include "structure/harmonic_solver.h"
#include "structure/paper_forms.h"
#include "structure/solver_report.h"
#include "uv/evening.h"
#include "uv/uv_map.h"

namespace holomorph::bindings {
namespace {

using flat::PlaneMap;

std::pair<py::array, py::array> zeros(const mesh::Surface& surface, const Contiguous<double>& uv,
                                      const std::vector<int>& poles) {
  return zeros_by_columns(uv::zeros(surface, corners(uv), poles));
}

structure::HarmonicMap harmonic_map(const mesh::Surface& surface, const Contiguous<double>& corner_values,
                                    const std::string& solver, int threads, const py::object& progress_function) {
  using Rows = forms::RowMajorMatrix;
  const Rows given = Eigen::Map<const Rows>(corner_values.data(), corner_values.shape(0), corner_values.shape(1));
  Execution execution(threads, callback(progress_function));
  const py::gil_scoped_release unlocked;
  return structure::harmonic_map(surface, given, {solver}, execution);
}

// #V x 2. The facade has checked shapes and vertices, and that the surface is connected.
py::array evened(const mesh::Surface& surface, const Contiguous<double>& uv, std::vector<int> poles, std::vector<int> u,
                 std::vector<int> v, double evenness, const std::string& solver, int threads,
                 const py::object& progress) {
  uv::UvArray given = corners(uv);
  uv::UvArray result;
  Execution execution(threads, callback(progress));
  {
    const py::gil_scoped_release unlocked;
    execution.stage("evening", 0.0, 1.0);
    result = uv::evened(surface, std::move(given), {std::move(poles), std::move(u), std::move(v), {}, {}}, evenness,
                        execution, {.solver = solver});
    execution.finish();
  }
  return give_matrix(std::move(result));
}

// The surface's own triangles, those without area mollified.
mesh::IntrinsicTriangulation own_triangles(const mesh::Surface& surface, Execution& execution) {
  return mesh::intrinsic_triangulation(surface, mesh::half_edges(surface, execution), execution.workers());
}

// The star of a form on the edges of any surface.
py::array averaged_star(const mesh::Surface& surface, const Contiguous<double>& form) {
  if (form.size() != static_cast<py::ssize_t>(surface.edges.size()))
    throw py::value_error("a form needs one value for each edge");
  Execution execution;
  return copy(forms::averaged_star(own_triangles(surface, execution), values(form)));
}

// (#E,) on the surface's own triangles.
py::array edge_weights(const mesh::Surface& surface) {
  Execution execution;
  return give(mesh::cotangent_weights(own_triangles(surface, execution), execution));
}

void bind_uv_maps(py::module_& m) {
  using structure::HarmonicMap;
  py::class_<HarmonicMap>(m, "HarmonicMap")
      .def_property_readonly("moves", [](const HarmonicMap& map) { return copy(map.moves); })
      .def_readonly("solver", &HarmonicMap::solver);
  m.def("evened", &evened, py::arg("surface"), py::arg("uv"), py::kw_only(), py::arg("poles"), py::arg("u"),
        py::arg("v"), py::arg("evenness"), py::arg("solver"), py::arg("threads"), py::arg("progress"));
  m.def("zeros", &zeros, py::arg("surface"), py::arg("uv"), py::arg("poles"));
  m.def(
      "frame",
      [](const mesh::Surface& surface, const Contiguous<double>& uv, double rotation, int threads) {
        const uv::Frame found = unlocked(threads, py::none(), [&](Execution& execution) {
          return uv::frame(surface, corners(uv), rotation, execution.workers());
        });
        return std::tuple(found.low, found.high, found.area);
      },
      py::arg("surface"), py::arg("uv"), py::arg("rotation"), py::arg("threads"));
  m.def("harmonic_map", &harmonic_map, py::arg("surface"), py::arg("corner_values"), py::arg("solver"),
        py::arg("threads"), py::arg("progress"));
  m.def("averaged_star", &averaged_star, py::arg("surface"), py::arg("form"));
  m.def("edge_weights", &edge_weights, py::arg("surface"));
}

std::shared_ptr<PlaneMap> rectangle(const mesh::Surface& surface, const std::vector<int>& corners,
                                    const std::vector<int>& labels, const std::string& solver, int threads,
                                    const py::object& progress_function) {
  Execution execution(threads, callback(progress_function));
  const py::gil_scoped_release unlocked;
  return std::make_shared<PlaneMap>(flat::rectangle_map(surface, corners, labels, {solver}, execution));
}

// One without a choice.
auto plane_map(PlaneMap (*function)(const mesh::Surface&, const flat::Options&, Execution&)) {
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
  m.def("free_boundary_map", plane_map(&flat::free_boundary_map), py::arg("surface"), py::arg("solver"),
        py::arg("threads"), py::arg("progress"));
  m.def("quarter_corners", of_surface(&flat::quarter_corners), py::arg("surface"));
  m.def("clear_corners", of_surface(&flat::clear_corners), py::arg("surface"));
}

void bind_records(py::module_& m) {
  using structure::LevelReport;
  using structure::MemoryPlan;
  using structure::SolverReport;
  py::class_<Residuals>(m, "Residuals")
      .def_readonly("closedness", &Residuals::closedness)
      .def_readonly("harmonicity", &Residuals::harmonicity)
      .def_readonly("periods", &Residuals::periods)
      .def_readonly("pairing", &Residuals::pairing)
      .def_readonly("asymmetry", &Residuals::asymmetry);
  py::class_<LevelReport>(m, "LevelReport")
      .def_readonly("faces", &LevelReport::faces)
      .def_readonly("iterations", &LevelReport::iterations)
      .def_readonly("seconds", &LevelReport::seconds);
  py::class_<SolverReport>(m, "SolverReport")
      .def_readonly("name", &SolverReport::name)
      .def_readonly("reason", &SolverReport::reason)
      .def_readonly("iterations", &SolverReport::iterations)
      .def_readonly("residual", &SolverReport::residual)
      .def_readonly("levels", &SolverReport::levels);
  py::class_<MemoryPlan>(m, "MemoryPlan")
      .def_readonly("keeps_forms", &MemoryPlan::keep_forms)
      .def_readonly("block", &MemoryPlan::block)
      .def_readonly("bytes", &MemoryPlan::bytes);
}

}  // namespace

void bind_maps(py::module_& m) {
  bind_records(m);
  bind_uv_maps(m);
  bind_plane_maps(m);
}

}  // namespace holomorph::bindings
